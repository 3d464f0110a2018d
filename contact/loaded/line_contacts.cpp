// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/line_contacts.hpp"

#include "contact/half_space/line_on_strips.hpp"

#include <algorithm>

namespace flank
{
  LineContacts line_contacts(const GearPair &pair, const PositionGrid &grid, const ContactSolution &solution)
  {
    struct OfSlice
    {
      std::vector<half_space::LoadedStrip> strips;
      std::vector<int> cells; ///< of the strips
      double max_pressure = 0;
      bool cut_short = false; ///< by an edge of a flank
    };
    std::vector<OfSlice> of(grid.slices().size());
    for (const int i : solution.active)
      if (const double force = solution.force[i]; force > 0)
        {
          const ContactCell &cell = grid.cells()[static_cast<std::size_t>(i)];
          const Slice &slice = grid.slices()[static_cast<std::size_t>(cell.slice)];
          OfSlice &s = of[static_cast<std::size_t>(cell.slice)];
          s.strips.push_back(
              { .place = profile_length(slice.pinion_roll, cell.pinion.roll, pair.pinion.base_radius),
                .half_width = cell.pinion.half_profile,
                .load_per_length = force / (2 * cell.pinion.half_generator) });
          s.cells.push_back(i);
          s.max_pressure = std::max(s.max_pressure, force / cell.area);
          s.cut_short = s.cut_short || cell.cut_short;
        }
    LineContacts result{ .excess_approach = std::vector<double>(of.size(), 0.0),
                         .excess_by_force = Eigen::VectorXd::Zero(solution.force.size()),
                         .certainty = std::vector<double>(of.size(), 0.0),
                         .pressure = solution.force };
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      result.pressure[static_cast<Eigen::Index>(i)] /= grid.cells()[i].area;
    const double modulus = effective_modulus(pair);
    for (std::size_t s = 0; s < of.size(); ++s)
      if (!of[s].cut_short)
        if (const auto line = half_space::line_on_strips(of[s].strips, modulus))
          {
            result.certainty[s] = line->certainty;
            result.excess_approach[s] = line->excess_approach;
            const double scale = 1 + line->certainty * (line->max_pressure / of[s].max_pressure - 1);
            for (std::size_t k = 0; k < of[s].cells.size(); ++k)
              {
                const int i = of[s].cells[k];
                result.excess_by_force[i] =
                    line->excess_by_load[k] /
                    (2 * grid.cells()[static_cast<std::size_t>(i)].pinion.half_generator);
                result.pressure[i] *= scale;
              }
          }
    return result;
  }

  /// By gaps the rotation changes as if each slice's surfaces stood that much further apart, so that the
  /// excess adds W_s a_s, W_s the sum of dtheta/dg over the slice, which forces do not change. What the
  /// excess itself depends on are the forces.
  Turned turned(const PositionGrid &grid, const ContactSolution &solution, const LineContacts &contacts,
                SimplexSolver &solver)
  {
    const Sensitivities exact = solver.sensitivities(solution);
    const auto slice_of = [&](const Eigen::Index i) {
      return static_cast<std::size_t>(grid.cells()[static_cast<std::size_t>(i)].slice);
    };
    const Eigen::Index n = solution.force.size();
    std::vector<double> weight(grid.slices().size(), 0.0);
    for (Eigen::Index i = 0; i < n; ++i)
      weight[slice_of(i)] += exact.theta_by_gap[i];
    double excess = 0;
    for (std::size_t s = 0; s < weight.size(); ++s)
      excess += weight[s] * contacts.excess_approach[s];
    Eigen::VectorXd by_force(n);
    for (Eigen::Index i = 0; i < n; ++i)
      by_force[i] = weight[slice_of(i)] * contacts.excess_by_force[i];
    const double flexibility =
        solution.stiffness > 0 ? 1 / solution.stiffness - by_force.dot(exact.force_by_torque) : 0;
    return { .theta = solution.theta - excess,
             .stiffness = flexibility > 0 ? 1 / flexibility : solution.stiffness,
             .by_gap = exact.theta_by_gap - solver.forces_by_gap(solution, exact, by_force) };
  }
} // namespace flank
