// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/active_block.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr Eigen::Index panel = 48,
                           tile = 96; // operands of one tile product stay within Eigen's stack buffers
  }

  void Equilibrated::add_deflection(const std::vector<int> &cells, const Eigen::VectorXd &force,
                                    Eigen::VectorXd &w) const
  {
    // Four columns at a time: w is read and written a quarter as often.
    std::size_t k = 0;
    const auto n = size();
    for (; k + 4 <= cells.size(); k += 4)
      {
        const double *c0 = compliance->col(cells[k]).data(), *c1 = compliance->col(cells[k + 1]).data(),
                     *c2 = compliance->col(cells[k + 2]).data(), *c3 = compliance->col(cells[k + 3]).data();
        const double f0 = scale[cells[k]] * force[k], f1 = scale[cells[k + 1]] * force[k + 1],
                     f2 = scale[cells[k + 2]] * force[k + 2], f3 = scale[cells[k + 3]] * force[k + 3];
        for (Eigen::Index i = 0; i < n; ++i)
          w[i] += scale[i] * ((f0 * c0[i] + f1 * c1[i]) + (f2 * c2[i] + f3 * c3[i]));
      }
    for (; k < cells.size(); ++k)
      w.array() += scale[cells[k]] * force[k] * scale.array() * compliance->col(cells[k]).array();
  }

  bool cholesky_in_place(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> a)
  {
    const Eigen::Index n = a.rows();
    for (Eigen::Index begin = 0; begin < n; begin += panel)
      {
        const Eigen::Index size = std::min(panel, n - begin), end = begin + size;
        for (Eigen::Index j = begin; j < end; ++j)
          {
            const double before = a(j, j);
            const double pivot = before - a.row(j).segment(begin, j - begin).squaredNorm();
            if (!(pivot > 1e-15 * std::abs(before)))
              return false;
            const double root = std::sqrt(pivot);
            a(j, j) = root;
            for (Eigen::Index k = begin; k < j; ++k)
              a.col(j).segment(j + 1, end - j - 1) -= a(j, k) * a.col(k).segment(j + 1, end - j - 1);
            a.col(j).segment(j + 1, end - j - 1) /= root;
          }
        const auto diagonal = a.block(begin, begin, size, size).transpose().triangularView<Eigen::Upper>();
        for (Eigen::Index row = end; row < n; row += tile)
          diagonal.template solveInPlace<Eigen::OnTheRight>(
              a.block(row, begin, std::min(tile, n - row), size));
        for (Eigen::Index column = end; column < n; column += tile)
          for (Eigen::Index row = column; row < n; row += tile)
            {
              const Eigen::Index rows = std::min(tile, n - row), columns = std::min(tile, n - column);
              a.block(row, column, rows, columns).noalias() -=
                  a.block(row, begin, rows, size) * a.block(column, begin, columns, size).transpose();
            }
      }
    return true;
  }

  Eigen::Map<Eigen::MatrixXd> ActiveBlock::block()
  {
    const auto m = static_cast<Eigen::Index>(cells_.size());
    return { memory_.data(), m, m };
  }
  Eigen::Map<const Eigen::MatrixXd> ActiveBlock::block() const
  {
    const auto m = static_cast<Eigen::Index>(cells_.size());
    return { memory_.data(), m, m };
  }

  bool ActiveBlock::factor(const Equilibrated &problem, const std::vector<int> &cells)
  {
    cells_ = cells;
    symmetric_ = problem.symmetric;
    if (memory_.size() < cells.size() * cells.size())
      memory_.resize(cells.size() * cells.size());
    auto a = block();
    const auto m = a.rows();
    for (Eigen::Index j = 0; j < m; ++j)
      {
        const double *column = problem.compliance->col(cells[j]).data();
        const double factor = problem.scale[cells[j]];
        for (Eigen::Index i = symmetric_ ? j : 0; i < m; ++i)
          a(i, j) = factor * problem.scale[cells[i]] * column[cells[i]];
        a(j, j) *= 1 + problem.regularisation;
      }
    bool good = true;
    if (symmetric_)
      good = cholesky_in_place(a);
    else if (m > 0)
      {
        lu_.compute(a);
        good = lu_.matrixLU().diagonal().cwiseAbs().minCoeff() >
               1e-15 * lu_.matrixLU().diagonal().cwiseAbs().maxCoeff();
      }
    if (!good)
      cells_.clear();
    return good;
  }

  void ActiveBlock::solve(Eigen::Ref<Eigen::VectorXd> x) const
  {
    if (cells_.empty())
      return;
    if (!symmetric_)
      {
        x = lu_.solve(x).eval();
        return;
      }
    block().triangularView<Eigen::Lower>().solveInPlace(x);
    block().transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  }

  void ActiveBlock::solve_transposed(Eigen::Ref<Eigen::VectorXd> x) const
  {
    if (symmetric_)
      solve(x);
    else if (!cells_.empty())
      x = lu_.transpose().solve(x).eval();
  }

  void ActiveBlock::invert(Eigen::Ref<Eigen::MatrixXd> inverse) const
  {
    inverse.setIdentity();
    if (cells_.empty())
      return;
    if (!symmetric_)
      {
        inverse = lu_.inverse();
        return;
      }
    const Eigen::Index m = inverse.rows();
    // Column blocks of L^-1 are zero above themselves.
    for (Eigen::Index begin = 0; begin < m; begin += tile)
      {
        const Eigen::Index size = std::min(tile, m - begin);
        auto part = inverse.block(begin, begin, m - begin, size);
        block().bottomRightCorner(m - begin, m - begin).triangularView<Eigen::Lower>().solveInPlace(part);
      }
    // X'X with X = L^-1, in place: row blocks of a column from the top, columns from the left, so that what
    // is overwritten is needed no more.
    for (Eigen::Index column = 0; column < m; column += tile)
      {
        const Eigen::Index columns = std::min(tile, m - column);
        for (Eigen::Index row = column; row < m; row += tile)
          {
            const Eigen::Index rows = std::min(tile, m - row);
            Eigen::MatrixXd part = Eigen::MatrixXd::Zero(rows, columns);
            for (Eigen::Index k = row; k < m; k += tile)
              {
                const Eigen::Index size = std::min(tile, m - k);
                part.noalias() +=
                    inverse.block(k, row, size, rows).transpose() * inverse.block(k, column, size, columns);
              }
            inverse.block(row, column, rows, columns) = part;
          }
      }
    inverse.triangularView<Eigen::StrictlyUpper>() = inverse.transpose();
  }
} // namespace flank
