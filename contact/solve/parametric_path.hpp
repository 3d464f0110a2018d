// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/active_block.hpp"

#include <optional>

namespace flank
{
  /// A corner of the piecewise linear theta(T).
  struct Breakpoint
  {
    double torque;    ///< T [N mm]
    double theta;     ///< [rad]
    double stiffness; ///< dT/dtheta on the piece above it (towards greater torque) [N mm/rad]
    int cell;         ///< that enters or leaves here; -1 at the ends
  };

  /// The finite pivoting simplex: follows the solution of
  ///     w = C' f + q(s) >= 0,  f >= 0,  f . w = 0,   q(s) = q0 + s d,
  /// from a known solution at s; at each breakpoint one cell enters or leaves (the least index of those that
  /// tie). With d = -l it is the sweep over torques by the parametric pivoting of Keller (1973) and Lemke
  /// (1965), s = theta. Keeps C'_AA^-1 and updates it.
  class ParametricPath
  {
  public:
    explicit ParametricPath(const Equilibrated &problem);

    enum class End
    {
      reached,   ///< the torque, or s_end
      unbounded, ///< no cell stops the way and the torque does not grow: it cannot be carried
      lost       ///< pivot bound, or the block lost definiteness
    };

    /// From s towards s_end (may be infinite), or until l . f = torque. `active` is the basis before and
    /// after; record, if given, receives the breakpoints in the order of the way (theta = s, of the
    /// equilibrated problem).
    End follow(std::vector<int> &active, const Eigen::VectorXd &q0, const Eigen::VectorXd &d, double &s,
               double s_end, std::optional<double> torque, std::vector<Breakpoint> *record = nullptr);

    int pivots() const { return pivots_; }

  private:
    bool rebuild(const std::vector<int> &active);
    bool append(const std::vector<int> &active, int cell);
    void remove(Eigen::Index k, Eigen::Index m);

    const Equilibrated &problem_;
    ActiveBlock block_;
    Eigen::MatrixXd inverse_;
    int pivots_ = 0;
  };
} // namespace flank
