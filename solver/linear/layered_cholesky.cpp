// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/linear/layered_cholesky.hpp"

#include "mesh/base/errors.hpp"

namespace flank
{
  LayeredCholesky::LayeredCholesky(const std::vector<Eigen::Index> &size, std::vector<int> last)
      : last_(std::move(last))
      , begin_{ 0 }
  {
    FLANK_ASSERT(last_.size() == size.size(), "a last layer for each");
    for (const Eigen::Index s : size)
      begin_.push_back(begin_.back() + s);
    for (std::size_t t = 0; t < size.size(); ++t)
      panel_.emplace_back(Eigen::MatrixXd::Zero(begin_[last_[t] + 1] - begin_[t], size[t]));
  }

  bool LayeredCholesky::factor()
  {
    for (int t = 0; t < n_layers(); ++t)
      {
        const Eigen::Index n = panel_[t].cols();
        if (n == 0)
          continue;
        auto diagonal = panel_[t].topRows(n);
        const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(diagonal);
        if (factor.info() != Eigen::Success)
          return false;
        auto coupling = panel_[t].bottomRows(below(t));
        diagonal.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(coupling);
        for (int s = t + 1; s <= last_[t]; ++s)
          {
            const Eigen::Index first = begin_[s] - begin_[t + 1], columns = panel_[s].cols(),
                               rows = coupling.rows() - first;
            panel_[s].topRows(rows).noalias() -=
                coupling.bottomRows(rows) * coupling.middleRows(first, columns).transpose();
          }
      }
    return true;
  }

  void LayeredCholesky::solve_in_place(Eigen::Ref<Eigen::MatrixXd> x) const
  {
    for (int t = 0; t < n_layers(); ++t)
      if (const Eigen::Index n = panel_[t].cols(); n > 0)
        {
          auto own = x.middleRows(begin_[t], n);
          panel_[t].topRows(n).triangularView<Eigen::Lower>().solveInPlace(own);
          x.middleRows(begin_[t + 1], below(t)).noalias() -= panel_[t].bottomRows(below(t)) * own;
        }
    for (int t = n_layers() - 1; t >= 0; --t)
      if (const Eigen::Index n = panel_[t].cols(); n > 0)
        {
          auto own = x.middleRows(begin_[t], n);
          own.noalias() -= panel_[t].bottomRows(below(t)).transpose() * x.middleRows(begin_[t + 1], below(t));
          panel_[t].topRows(n).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
        }
  }
} // namespace flank
