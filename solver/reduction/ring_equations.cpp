// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/ring_equations.hpp"

#include "mesh/base/errors.hpp"

#include <Eigen/Eigenvalues>

namespace flank
{
  namespace
  {
    /// The Cholesky factor of a symmetric positive definite matrix, in the lower triangle of the result; the
    /// upper one is left as it was.
    template <class Matrix>
    Matrix factored(Matrix system)
    {
      const Eigen::LLT<Eigen::Ref<Matrix>> factor(system);
      if (factor.info() != Eigen::Success)
        throw ComputationError("the condensed ring is not positive definite");
      return system;
    }
  } // namespace

  Eigen::MatrixXcd ComplexRingEquations::factor(const Complex phase) const
  {
    Eigen::MatrixXcd system = (sector_.plus_plus + sector_.minus_minus).cast<Complex>();
    system += std::conj(phase) * sector_.plus_minus.cast<Complex>() +
              phase * sector_.plus_minus.transpose().cast<Complex>();
    return factored(std::move(system));
  }

  Eigen::MatrixXcd ComplexRingEquations::half_solution(const Eigen::MatrixXcd &factor, const Sides &sides,
                                                       const Complex phase) const
  {
    Eigen::MatrixXcd half = std::conj(phase) * sides.plus.cast<Complex>() + sides.minus.cast<Complex>();
    factor.triangularView<Eigen::Lower>().solveInPlace(half);
    return half;
  }

  ComplexParts ComplexRingEquations::product(const Eigen::MatrixXcd &first,
                                             const Eigen::MatrixXcd &second) const
  {
    const Eigen::MatrixXcd all = first.adjoint() * second;
    return { all.real(), all.imag() };
  }

  Eigen::VectorXcd ComplexRingEquations::solve(const Eigen::MatrixXcd &factor,
                                               const Eigen::VectorXcd &force) const
  {
    Eigen::VectorXcd u = force;
    factor.triangularView<Eigen::Lower>().solveInPlace(u);
    factor.triangularView<Eigen::Lower>().adjoint().solveInPlace(u);
    return u;
  }

  RealRingEquations::RealRingEquations(const CondensedSector &sector)
  {
    // A node and its image: sums and differences; a node that is its own image: the axes of the 3 x 3 matrix
    // itself.
    const auto &[image, turn] = *sector.symmetry;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> own(turn);
    std::vector<std::vector<std::pair<Eigen::Index, double>>> even, odd;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(image.size()); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        {
          const Eigen::Index j = image[i];
          if (j == i)
            {
              auto &vector = (own.eigenvalues()[c] > 0 ? even : odd).emplace_back();
              for (Eigen::Index d = 0; d < 3; ++d)
                vector.emplace_back(3 * i + d, own.eigenvectors()(d, c));
            }
          else if (i < j)
            for (const double sign : { 1.0, -1.0 })
              {
                auto &vector = (sign > 0 ? even : odd).emplace_back();
                vector.emplace_back(3 * i + c, std::sqrt(0.5));
                for (Eigen::Index d = 0; d < 3; ++d)
                  vector.emplace_back(3 * j + d, sign * std::sqrt(0.5) * turn(d, c));
              }
        }
    n_even_ = static_cast<Eigen::Index>(even.size());
    even.insert(even.end(), odd.begin(), odd.end());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < even.size(); ++k)
      for (const auto &[row, value] : even[k])
        entries.emplace_back(row, k, value);
    const Eigen::Index n = sector.n_cut();
    basis_.resize(n, n);
    basis_.setFromTriplets(entries.begin(), entries.end());

    const auto in_basis = [&](const Eigen::MatrixXd &m) -> Eigen::MatrixXd {
      return basis_.transpose() * Eigen::MatrixXd(m * basis_);
    };
    const Eigen::MatrixXd coupling = in_basis(sector.plus_minus);
    stiffness_ = in_basis(sector.plus_plus + sector.minus_minus);
    sum_ = coupling + coupling.transpose();
    difference_ = coupling.transpose() - coupling;
  }

  RealRingEquations::Sides RealRingEquations::sides(const Eigen::MatrixXd &plus,
                                                    const Eigen::MatrixXd &minus) const
  {
    return { basis_.transpose() * plus, basis_.transpose() * minus };
  }

  Eigen::MatrixXd RealRingEquations::factor(const Complex phase) const
  {
    // A and B + B' couple even with even, odd with odd; B' - B, which comes with i sin, even with odd, whose
    // vectors come with i.
    const Eigen::Index n_odd = stiffness_.rows() - n_even_;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(stiffness_.rows(), stiffness_.cols());
    system.topLeftCorner(n_even_, n_even_) =
        stiffness_.topLeftCorner(n_even_, n_even_) + phase.real() * sum_.topLeftCorner(n_even_, n_even_);
    system.bottomRightCorner(n_odd, n_odd) =
        stiffness_.bottomRightCorner(n_odd, n_odd) + phase.real() * sum_.bottomRightCorner(n_odd, n_odd);
    system.bottomLeftCorner(n_odd, n_even_) = phase.imag() * difference_.bottomLeftCorner(n_odd, n_even_);
    return factored(std::move(system));
  }

  Eigen::MatrixXd RealRingEquations::half_solution(const Eigen::MatrixXd &factor, const Sides &sides,
                                                   const Complex phase) const
  {
    const Eigen::Index n = sides.plus.rows(), loads = sides.plus.cols(), n_odd = n - n_even_;
    Eigen::MatrixXd half(n, 2 * loads);
    auto real = half.leftCols(loads), imaginary = half.rightCols(loads);
    real.topRows(n_even_) = phase.real() * sides.plus.topRows(n_even_) + sides.minus.topRows(n_even_);
    imaginary.topRows(n_even_) = -phase.imag() * sides.plus.topRows(n_even_);
    real.bottomRows(n_odd) = -phase.imag() * sides.plus.bottomRows(n_odd); // times conj(i)
    imaginary.bottomRows(n_odd) =
        -phase.real() * sides.plus.bottomRows(n_odd) - sides.minus.bottomRows(n_odd);
    factor.triangularView<Eigen::Lower>().solveInPlace(half);
    return half;
  }

  ComplexParts RealRingEquations::product(const Eigen::MatrixXd &first, const Eigen::MatrixXd &second) const
  {
    const Eigen::Index n = first.cols() / 2, m = second.cols() / 2;
    const Eigen::MatrixXd all = first.transpose() * second;
    return { all.topLeftCorner(n, m) + all.bottomRightCorner(n, m),
             all.topRightCorner(n, m) - all.bottomLeftCorner(n, m) };
  }

  ComplexParts RealRingEquations::square(const Eigen::MatrixXd &half) const
  {
    const Eigen::Index n = half.cols() / 2;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    all.selfadjointView<Eigen::Lower>().rankUpdate(half.transpose());
    Eigen::MatrixXd real = all.topLeftCorner(n, n) + all.bottomRightCorner(n, n); // its lower triangle
    real.triangularView<Eigen::StrictlyUpper>() = real.transpose();
    const Eigen::MatrixXd below = all.bottomLeftCorner(n, n);
    return { std::move(real), below.transpose() - below };
  }

  Eigen::VectorXcd RealRingEquations::solve(const Eigen::MatrixXd &factor,
                                            const Eigen::VectorXcd &force) const
  {
    const Eigen::Index n = basis_.rows(), n_odd = n - n_even_;
    Eigen::VectorXcd in_basis = basis_.transpose() * force;
    in_basis.tail(n_odd) *= Complex(0, -1);
    Eigen::MatrixXd parts(n, 2);
    parts << in_basis.real(), in_basis.imag();
    factor.triangularView<Eigen::Lower>().solveInPlace(parts);
    factor.triangularView<Eigen::Lower>().transpose().solveInPlace(parts);
    in_basis.real() = parts.col(0);
    in_basis.imag() = parts.col(1);
    in_basis.tail(n_odd) *= Complex(0, 1);
    return basis_ * in_basis;
  }
} // namespace flank
