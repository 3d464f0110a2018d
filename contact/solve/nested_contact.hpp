// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/active_block.hpp"

#include <optional>

namespace flank
{
  /// Cells and the torques at which they are expected to come into contact as the torque grows. [N mm]
  struct ExpectedContact
  {
    std::vector<int> cells;
    std::vector<double> entry;
  };

  /// Torque at which an active cell came into contact, from its force and the force's derivative: exact for a
  /// line contact whose load grows linearly with the torque, because the square of the pressure then does. [N
  /// mm]
  double entry_torque(double torque, double force, double force_by_torque);

  /// Contacts of many torques from one Cholesky factor L. Its cells stand in the order in which they are
  /// expected to come into contact, so that the active ones of any torque are nearly a leading part. The
  /// core, a leading part that is surely in contact, is eliminated by the leading part of the factor (static
  /// condensation); the rim, the cells about where contact ends, remains as a contact problem of the same
  /// form for few cells, with the rows L_K of the factor that are theirs, behind the core:
  ///     w = S f + g' - theta l' >= 0,  f >= 0,  f . w = 0,   S = L_K L_K' (Schur complement),  l' = L_K L^-1
  ///     l,  g' = L_K L^-1 g.
  /// Core and rim are guesses: cells that turn out on the wrong side join the rim, until none is.
  /// Symmetric problems and torques > 0. Cells it does not hold are not looked at.
  class NestedContact
  {
  public:
    /// The problem is kept by reference.
    explicit NestedContact(const Equilibrated &problem);

    /// Adds cells, each once, behind those that it holds. False where the block is not positive definite to
    /// working precision; then this object is of no more use.
    bool append(ExpectedContact cells);

    const std::vector<int> &cells() const { return cells_; }

    struct Contact
    {
      double theta = 0;         ///< from first touch [rad]
      double stiffness = 0;     ///< dT/dtheta [N mm/rad]
      Eigen::VectorXd force;    ///< on cells(), of the equilibrated problem
      std::vector<char> active; ///< of cells()
      int pivots = 0;
    };
    /// Pivots in the rim of cells that may come or go, and moves cells into it until every one is on its
    /// side; all steps share the rim and its forces. Nothing where block pivoting does not end or the rim is
    /// not positive definite. Where it succeeds, cells are expected from then on as this solution tells.
    std::optional<Contact> solve(double torque);

    /// The active cells of the last solution.
    ExpectedContact expected(const Contact &last) const;

  private:
    struct Rim;
    Rim around(Eigen::Index core, const std::vector<char> &in_rim) const;
    bool pivot(Rim &rim, double torque, Contact &contact) const;
    Eigen::VectorXd forces(const Rim &rim, const Eigen::VectorXd &of_rim, Eigen::VectorXd &rigid) const;

    const Equilibrated &problem_;
    Eigen::MatrixXd factor_; ///< L: lower triangle of the top left corner
    std::vector<int> cells_;
    std::vector<double> entry_;   ///< as expected [N mm]
    double solved_ = 0;           ///< torque that entry_ was last learned at [N mm]; 0: none since cells came
    Eigen::VectorXd lever_, gap_; ///< L^-1 l, L^-1 g
  };
} // namespace flank
