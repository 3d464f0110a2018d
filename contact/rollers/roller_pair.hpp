// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/half_space/hertz.hpp"
#include "contact/half_space/subsurface.hpp"
#include "contact/solve/certificate.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace flank
{
  class RollerEnds;

  /// A cylinder that is pressed against another one at mid-length. [mm, MPa]
  struct CrownedRoller
  {
    double radius = 0, length = 0;
    double crown_radius = 0;    ///< lengthwise, of the profile that falls away from the cylinder; 0: straight
                                ///< over the whole length
    double straight_length = 0; ///< in the middle, where the crown has not begun
    double youngs_modulus = 0, poissons_ratio = 0;

    /// How far the surface stands back from the tangent plane at `across` its axis and `along` it from
    /// mid-length. [mm]
    double stand_back(double across, double along) const;
  };

  /// Two rollers whose middles meet. The axes lie in planes parallel to the tangent plane.
  struct RollerPairData
  {
    CrownedRoller first, second;
    double crossing_angle =
        0; ///< from the first axis to the second one, seen along the normal from the second roller [rad]

    /// Whether the ends of rollers with parallel axes are free; null: the half-space goes on there.
    std::shared_ptr<const RollerEnds> free_ends = nullptr;

    /// E*, with 1/E* the sum of (1 - nu^2)/E of both rollers. [MPa]
    double effective_modulus() const;

    /// Principal relative curvatures at mid-length, where crowns without a straight part count, and the
    /// direction of the least one: from the first axis towards the second one. [1/mm, 1/mm, rad]
    struct Curvatures
    {
      double least, greatest, direction;
    };
    Curvatures curvatures() const;

    /// Farthest point of a direction, from the first axis towards the second one, that both rollers face.
    /// [mm]
    double longest(double direction) const;
  };

  /// Cells of the grid over the contact: across and along its longer direction, both even.
  struct RollerPairGrid
  {
    int across = 32, along = 48;
  };

  /// A pressed cell of the contact, in the frame of the grid: x across, y along the direction of least
  /// relative curvature. [mm, MPa]
  struct PressedCell
  {
    double x, y, half_x, half_y, pressure;
  };

  /// What Hertz's formulas give beside the numerical contact: an ellipse where both principal curvatures
  /// differ from 0; a line of the shorter roller's length where the axes are parallel and no roller is
  /// crowned. Otherwise nothing: a straight part inside a crown has no closed form.
  struct HertzReference
  {
    std::optional<half_space::HertzEllipse> ellipse;
    std::optional<half_space::HertzLine> line;
    std::optional<half_space::SubsurfaceStress> subsurface; ///< below the middle of either
    std::string missing; ///< why there is neither ellipse nor line, of a loaded contact
  };

  /// The contact under one normal force.
  struct RollerPairContact
  {
    double approach = 0;     ///< of the rollers' axes [mm]
    double stiffness = 0;    ///< tangent, d force / d approach [N/mm]; 0 unloaded
    double max_pressure = 0; ///< of the cells away from the rollers' ends, before the pressure rises towards
                             ///< ends that the contact reaches: it does not depend on the grid [MPa]
    double inside_pressure = 0; ///< of all cells away from the rollers' ends; it grows as cells shrink where
                                ///< the ends carry more [MPa]
    double edge_pressure =
        0; ///< of the cells at the rollers' ends, where no half-space is; 0: the contact ends before [MPa]
    double end_intensity = 0; ///< where the pressure at free ends is singular: what it comes to, times the
                              ///< distance to the power -RollerEnds::pressure_exponent() [MPa, mm]
    double width = 0, length = 0; ///< of the loaded cells, across and along the grid [mm]
    Certificate certificate;
    std::vector<PressedCell> cells;
    std::size_t greatest = 0; ///< which of the cells has max_pressure; none: their number
  };

  /// Solves the contact on a grid that follows it: widened until the contact ends inside or at a roller's
  /// end, narrowed until it fills the grid. Force >= 0 [N]. Throws ComputationError where the solution or the
  /// grid does not pass its certificate, or where the contact would be so wide that the half-space holds no
  /// longer.
  RollerPairContact press(const RollerPairData &data, const RollerPairGrid &grid, double force);

  /// Greatest stresses below the cell of max_pressure, under all cells of a contact; of the roller where they
  /// are greater. Each roller counts as a half-space of its material. Zeros without such a cell.
  half_space::SubsurfaceStress below_greatest_pressure(const RollerPairData &data,
                                                       const RollerPairContact &contact);

  /// Hertz's formulas for the same contact; nothing where the force is 0.
  HertzReference hertz(const RollerPairData &data, double force);
} // namespace flank
