// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

namespace flank
{
  /// The problem as the solver works on it: forces measured in powers of two (f = D f', D nearest C_ii^-1/2:
  /// exact), the sense of the torque made positive, gaps counted from first touch (g' = D (g - theta_0 l)). C
  /// itself is not copied.
  struct Equilibrated
  {
    const Eigen::MatrixXd *compliance = nullptr;
    Eigen::VectorXd scale;      ///< D
    Eigen::VectorXd gap, lever; ///< D (g - theta_0 l), sense * D l
    double sense = 1;           ///< of the torque
    double first_touch = 0;     ///< theta_0 in that sense
    bool symmetric = true;
    double regularisation = 0; ///< relative addition to the diagonal

    Eigen::Index size() const { return gap.size(); }
    double entry(const Eigen::Index i, const Eigen::Index j) const
    {
      const double value = scale[i] * scale[j] * (*compliance)(i, j);
      return i == j ? value * (1 + regularisation) : value;
    }

    /// Rounding error of a difference, relative to its terms: a smaller difference counts as zero.
    static constexpr double rounding = 1e-13;

    /// Whether a cell's gap w [equilibrated] is negative beyond the rounding error of g - theta l (overlaps),
    /// or positive by no more than that error (touches).
    bool overlaps(const Eigen::Index cell, const double w, const double theta) const
    {
      return w < -rounded(cell, theta);
    }
    bool touches(const Eigen::Index cell, const double w, const double theta) const
    {
      return w <= rounded(cell, theta);
    }
    double rounded(const Eigen::Index cell, const double theta) const
    {
      return rounding * (std::abs(gap[cell]) + std::abs(theta * lever[cell]));
    }

    /// w += C' f over the cells listed. Columns of C are read in order.
    void add_deflection(const std::vector<int> &cells, const Eigen::VectorXd &force,
                        Eigen::VectorXd &w) const;
  };

  /// Factor of C' on a set of active cells: Cholesky, or LU where C is not symmetric. Its memory only grows,
  /// so that repeated solves of equal size allocate nothing (Cholesky).
  class ActiveBlock
  {
  public:
    /// False where the block is not positive definite (LU: singular) to working precision.
    bool factor(const Equilibrated &problem, const std::vector<int> &cells);

    /// x := C_AA^-1 x, in the order of the cells.
    void solve(Eigen::Ref<Eigen::VectorXd> x) const;
    void solve_transposed(Eigen::Ref<Eigen::VectorXd> x) const;

    /// The explicit inverse into the top left corner of `inverse`.
    void invert(Eigen::Ref<Eigen::MatrixXd> inverse) const;

    /// The cells whose block is factored; none after a failure or forget().
    const std::vector<int> &cells() const { return cells_; }
    void forget() { cells_.clear(); }

  private:
    Eigen::Map<Eigen::MatrixXd> block();
    Eigen::Map<const Eigen::MatrixXd> block() const;

    std::vector<int> cells_;
    std::vector<double> memory_;
    bool symmetric_ = true;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  };

  /// In-place Cholesky factorisation of the lower triangle, tile by tile, without heap memory. False where a
  /// pivot falls below 1e-15 of its diagonal entry (nothing but rounding is left of it).
  bool cholesky_in_place(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> a);
} // namespace flank
