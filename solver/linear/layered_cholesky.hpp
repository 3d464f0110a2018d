// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <vector>

namespace flank
{
  /// Cholesky factor of a symmetric positive definite matrix of unknowns in layers, each coupled to some of
  /// the following layers alone: blocks beyond are neither stored nor computed.
  class LayeredCholesky
  {
  public:
    /// size[t]: unknowns of layer t; last[t]: the last layer it is coupled to, not decreasing. The matrix
    /// begins as zeros.
    LayeredCholesky(const std::vector<Eigen::Index> &size, std::vector<int> last);

    int n_layers() const { return static_cast<int>(panel_.size()); }
    Eigen::Index begin(int layer) const
    {
      return begin_[layer];
    } ///< the first unknown of a layer; begin(n_layers()): the number of all unknowns

    /// The matrix's columns of a layer, from its diagonal down to the last layer it is coupled to: to be
    /// filled before factor(), the lower triangle alone.
    Eigen::MatrixXd &panel(int layer) { return panel_[layer]; }

    /// Factors the matrix in place. False: it is not positive definite.
    bool factor();

    /// Solves for several right sides, a column of x each, in place.
    void solve_in_place(Eigen::Ref<Eigen::MatrixXd> x) const;

  private:
    Eigen::Index below(int layer) const { return panel_[layer].rows() - panel_[layer].cols(); }

    std::vector<int> last_;
    std::vector<Eigen::Index> begin_;
    std::vector<Eigen::MatrixXd> panel_;
  };
} // namespace flank
