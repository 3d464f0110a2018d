// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/grid_certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// How much the springs of the mounting take back of the approach at a place with these levers. [mm]
    double yield(const MeshBodies &bodies, const double torsion_pinion, const double torsion_gear,
                 const Eigen::Vector4d &tilt, const Eigen::Matrix<double, 6, 1> &moment)
    {
      const Mounting &p = bodies.pinion_mounting, &g = bodies.gear_mounting;
      const double stiffness[6] = { p.torsion,     g.torsion,       p.tilt_in_plane,
                                    p.tilt_across, g.tilt_in_plane, g.tilt_across },
                   lever[6] = { torsion_pinion, torsion_gear, tilt[0], tilt[1], tilt[2], tilt[3] };
      double sum = 0;
      for (int k = 0; k < 6; ++k)
        sum += lever[k] * moment[k] / stiffness[k];
      return sum;
    }

    /// The cells on each slice, by tooth pair and place along the axis.
    std::vector<std::vector<Eigen::Index>> by_slice(const std::vector<Slice> &slices,
                                                    const std::vector<ContactCell> &cells)
    {
      std::vector<std::vector<Eigen::Index>> result(slices.size());
      const auto is_on = [&](const ContactCell &cell, const Slice &slice) {
        return cell.pinion.tooth == slice.pair &&
               2 * std::abs(cell.pinion.z - slice.z) <= slice.height * (1 + 1e-9);
      };
      std::size_t s = 0; // cells of a slice stand together: its neighbour is looked for once
      for (std::size_t i = 0; i < cells.size(); ++i)
        {
          for (std::size_t tried = 0; tried < slices.size() && !is_on(cells[i], slices[s]); ++tried)
            s = (s + 1) % slices.size();
          if (!slices.empty() && is_on(cells[i], slices[s]))
            result[s].push_back(static_cast<Eigen::Index>(i));
        }
      return result;
    }

    /// Whether a slice could touch without its cells to tell: it has none, or none of them carries and their
    /// window lies beside the place where the surfaces come closest. (Those of a tip edge are cut by it.)
    bool is_uncovered(const Slice &slice, const std::vector<Eigen::Index> &of_slice,
                      const std::vector<ContactCell> &cells, const Eigen::VectorXd &force,
                      const InvoluteHelicoid &pinion)
    {
      if (of_slice.empty() || slice.tip_edge)
        return of_slice.empty();
      Patch closest{};
      closest.roll = slice.pinion_roll;
      closest.z = slice.z;
      return std::ranges::none_of(of_slice, [&](const Eigen::Index i) {
        const Patch &cell = cells[static_cast<std::size_t>(i)].pinion;
        const double along = cell.seen_from(closest, pinion).x(); // also of cells that an edge cuts obliquely
        return force[i] > 0 || std::abs(along - slice.touch_offset) <= 2 * cell.half_profile;
      });
    }
  } // namespace

  GridCertificate certify_grid(const MeshBodies &bodies, const MeshPosition &position, const int cycle,
                               const std::vector<Slice> &slices, const std::vector<ContactCell> &cells,
                               const Eigen::VectorXd &force, const double theta)
  {
    const double greatest = force.size() > 0 ? force.maxCoeff() : 0, all = force.sum();
    Eigen::Matrix<double, 6, 1> moment = Eigen::Matrix<double, 6, 1>::Zero();
    const auto of_slice = by_slice(slices, cells);
    for (std::size_t s = 0; s < slices.size(); ++s)
      for (const Eigen::Index i : of_slice[s])
        if (force[i] != 0)
          {
            Eigen::Matrix<double, 6, 1> lever;
            lever << slices[s].lever, slices[s].gear_lever, cells[static_cast<std::size_t>(i)].tilt;
            moment += force[i] * lever;
          }

    GridCertificate result;
    for (std::size_t s = 0; s < slices.size(); ++s)
      {
        const Slice &slice = slices[s];
        if (is_uncovered(slice, of_slice[s], cells, force, bodies.pair.pinion.flank()))
          {
            const double touch = slice.touch + position.stand_back(slice, cycle);
            result.uncovered =
                std::max(result.uncovered,
                         theta * slice.lever -
                             yield(bodies, slice.lever, slice.gear_lever, slice.tilt, moment) - touch);
          }
        int loaded = 0;
        double load = 0;
        bool inside = true; // else an edge cuts the contact short, however fine the cells are
        for (const Eigen::Index i : of_slice[s])
          if (const ContactCell &cell = cells[static_cast<std::size_t>(i)]; force[i] > 0)
            {
              ++loaded;
              load += force[i];
              inside = inside && !cell.cut_short;
              if (cell.window_border)
                result.open = std::max(result.open, force[i] / greatest);
            }
        if (inside && loaded > 0 && loaded < GridCertificate::fewest)
          result.unresolved += load / all;
      }
    return result;
  }

  std::string GridCertificate::describe() const
  {
    std::string text;
    const auto say = [&](const std::string &what) { text += (text.empty() ? "" : "; ") + what; };
    if (!(uncovered <= 0))
      say(fmt::format("a slice without cells where it would touch is approached by {:.3g} um",
                      1e3 * uncovered));
    if (!(open <= 0))
      say(fmt::format("the grid ends in a cell with {:.3g} of the greatest force", open));
    if (!(unresolved <= most_unresolved))
      say(fmt::format(
          "{:.3g} of the load lies on slices with fewer than {} loaded cells, allowed is {:.3g}: more "
          "cells across a slice are needed (profile cells of the contact grid)",
          unresolved, fewest, most_unresolved));
    return text;
  }
} // namespace flank
