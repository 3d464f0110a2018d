// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"

#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace flank
{
  class RollerEnds;

  /// Two parallel cylinders of equal length pressed together, one of them crowned. [mm, MPa]
  struct RollerContactData
  {
    double roller_radius = 0, sleeve_radius = 0; ///< sleeve_radius < 0: hollow (conjugate profile)
    double width = 0;
    double roller_modulus = 0, roller_poisson = 0, sleeve_modulus = 0, sleeve_poisson = 0;
    double crown_radius = 0;    ///< 0: straight
    double straight_length = 0; ///< of a partial crown; 0: crowned from the middle

    /// The ends of both, which are free; null: the half-space goes on there.
    std::shared_ptr<const RollerEnds> free_ends = nullptr;

    /// Material removed at |y| from mid-width: R - sqrt(R^2 - (y - straight/2)^2) beyond the straight part.
    /// [mm]
    double crown(double y) const;
    double relative_radius() const { return 1 / (1 / roller_radius + 1 / sleeve_radius); }
    double surface_compliance() const; ///< sum over both bodies of (1 - nu^2)/(pi E) [mm^2/N]
  };

  struct RollerGridSize
  {
    int across = 20;      ///< cells over the whole contact width, even
    int along = 40;       ///< over the whole length, even
    bool uniform = false; ///< along: equal cells over the whole length, displacement at cell centres; else by
                          ///< load: shrunk to the contact, finer near ends
    double half_width = 0; ///< of a prescribed grid across [mm], the same at every load; 0: follows the load
  };

  /// The state of one pair under one force.
  struct PairState
  {
    double force = 0, approach = 0; ///< [N], [mm]
    double stiffness = 0;           ///< dF/d approach [N/mm]
    double mid_pressure = 0;        ///< greatest of the cells at mid-width [MPa]
    double edge_pressure =
        0; ///< greatest of the cells at the ends of the roller; 0 where the contact does not reach them [MPa]
    double max_pressure = 0; ///< over all cells [MPa]
    double certificate = 0;  ///< worst of the contact solutions that it is made of, relative
  };

  /// Cell pressures of one quarter (x, y >= 0); the others are its mirror images.
  struct PressureMap
  {
    std::vector<double> x, y, half_x, half_y, pressure; ///< centres, half-lengths [mm], [MPa]
  };

  /// Thrown for a contact so wide that its rollers are no half-spaces for it.
  struct BeyondHalfSpace : ComputationError
  {
    using ComputationError::ComputationError;
  };

  /// The load-approach law of a pair: solved and certified at forces a factor apart, each on a grid sized for
  /// it, when they are first asked for; in between a cubic through values and exact tangent stiffnesses of
  /// ln(approach) over ln(force). Safe to use from several threads.
  class PairLaw
  {
  public:
    PairLaw(const RollerContactData &data, const RollerGridSize &grid);

    /// State at an approach > 0 [mm].
    PairState at_approach(double approach) const;

    /// Force and stiffness at an approach, without pressures: what the load balance asks for again and again.
    PairState load_at(double approach) const;

    /// The cells' pressures under a force, on the grid that at_approach() has.
    PressureMap map(double force) const;

    /// Solves the contact under one force on a grid of its own; the law is made of such solutions. Throws
    /// ComputationError if not certified.
    PairState solve(double force, PressureMap *map = nullptr) const;

  private:
    /// Force at a node of the law. The nodes are a ladder in units of E* times a roller's section, so that
    /// rollers of another size or stiffness have the same ladder. [N]
    double node_force(int index) const;
    const PairState &node(int index) const;
    bool is_half_space(int index) const; ///< whether the node's contact is narrow enough

    /// The state at an approach above the last node that the half-space allows, where no second node makes an
    /// interval.
    PairState beyond(const PairState &last, double approach) const;
    PairState between(int index, double force) const;
    PairState below(double force) const;

    /// On a prescribed grid the law is exact: every corner of the one contact problem.
    PairState prescribed(double approach, bool pressures) const;

    /// The same under the force on a quarter [N], certified; its mutex held.
    PairState on_prescribed_cells(double load, PressureMap *map) const;
    struct Prescribed;

    RollerContactData data_;
    RollerGridSize grid_;
    mutable std::mutex mutex_;
    mutable std::map<int, PairState> nodes_;
    mutable int first_beyond_ = std::numeric_limits<int>::max(); ///< node whose contact is too wide
    std::shared_ptr<Prescribed> prescribed_;
  };

  /// The contact problem of one quarter on given cell borders (first 0, ascending), unknowns: forces of its
  /// cells, lever 1, so that l . f is a quarter of the pair's force. collocation: displacement at cell
  /// centres; else mean over cells.
  ContactProblem quarter_problem(const RollerContactData &data, const std::vector<double> &x,
                                 const std::vector<double> &y, bool collocation);
} // namespace flank
