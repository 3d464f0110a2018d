// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/loaded_pair.hpp"

#include "contact/solve/conditioning.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <map>

namespace flank
{
  namespace
  {
    /// Derivatives of the cells' mean gaps by the first parameters of the modifications: a row a cell, a
    /// column a parameter. [mm over its unit]
    Eigen::MatrixXd gap_derivatives(const MeshPosition &position, const PositionGrid &grid,
                                    const std::size_t count)
    {
      Eigen::MatrixXd result(static_cast<Eigen::Index>(grid.cells().size()),
                             static_cast<Eigen::Index>(count));
      for (Eigen::Index k = 0; k < result.cols(); ++k)
        for (Eigen::Index i = 0; i < result.rows(); ++i)
          {
            const ContactCell &cell = grid.cells()[i];
            result(i, k) =
                position.gap_derivative(grid.slices()[cell.slice], cell, static_cast<std::size_t>(k));
          }
      return result;
    }

    /// Half-spaces unless both bodies have free ends.
    EndsOfFlanks ends_of(const MeshBodies &bodies)
    {
      const auto are_free = [](const BodyCompliance &body) {
        return body.projected() && body.projected()->edges().are_free();
      };
      return are_free(bodies.pinion) && are_free(bodies.gear) ? EndsOfFlanks::free : EndsOfFlanks::half_space;
    }
  } // namespace

  LoadedPair LoadedPair::with(const std::vector<double> &values) const
  {
    LoadedPair other = *this;
    other.deviations = deviations.with(values);
    return other;
  }

  PositionCompliance LoadedPair::compliance() const
  {
    return { bodies.pinion, bodies.gear, bodies.pair.pinion.flank() };
  }

  PositionResult LoadedPair::unloaded(const double phase, const int cycle) const
  {
    PositionResult result;
    result.phase = phase + cycle;
    const MeshPosition position(bodies.pair, deviations, phase, ends_of(bodies));
    const int slices = 4 * bodies.grid.slices + 1;
    result.theta = position.first_touch(slices, cycle);
    for (std::size_t k = 0; k < n_parameters(); ++k)
      result.theta_by_parameter.push_back(position.first_touch_derivative(slices, cycle, k));
    return result;
  }

  std::vector<PositionResult> LoadedPair::solve(const double phase, const std::vector<double> &torques) const
  {
    return solve(phase, torques, { 0 }).front();
  }

  std::vector<std::vector<PositionResult>> LoadedPair::solve(const double phase,
                                                             const std::vector<double> &torques,
                                                             const std::vector<int> &cycles) const
  {
    PositionCompliance fresh = compliance();
    return solve(at(phase), torques, cycles, fresh);
  }

  SlicedPosition LoadedPair::at(const double phase) const
  {
    const MeshPosition position(bodies.pair, deviations, phase, ends_of(bodies));
    auto [slices, undivided] = position.slices_finer_at_corners(bodies.grid.slices);
    return { position, std::move(slices), undivided, bodies.pair.common_face_width / bodies.grid.slices };
  }

  std::vector<std::vector<PositionResult>> LoadedPair::solve(const SlicedPosition &sliced,
                                                             const std::vector<double> &torques,
                                                             const std::vector<int> &cycles,
                                                             PositionCompliance &compliance) const
  {
    std::vector<std::vector<PositionResult>> results;
    std::map<std::vector<StandBack>, std::size_t> solved; // by how far the pairs stand back
    for (const int cycle : cycles)
      {
        std::vector<StandBack> stand_back;
        for (std::size_t s = 0; s < sliced.slices.size(); ++s)
          if (const int pair = sliced.slices[s].pair; s == 0 || pair != sliced.slices[s - 1].pair)
            stand_back.push_back(sliced.position.stand_back(pair, cycle));
        const auto [like, is_new] = solved.try_emplace(std::move(stand_back), results.size());
        if (is_new)
          results.push_back(solve_cycle(sliced, torques, cycle, compliance));
        else
          results.emplace_back(results[like->second]);
        for (PositionResult &result : results.back())
          {
            result.phase = sliced.position.phase() + cycle;
            if (results.size() > 1) // cells of later cycles are not kept
              {
                result.grid_cells.reset(), result.cell_forces.clear();
                result.contact_cells.reset();
                result.contact_force.resize(0), result.contact_gap.resize(0);
              }
          }
      }
    return results;
  }

  std::vector<std::vector<PositionResult>> LoadedPair::solve_what_can_be(const SlicedPosition &sliced,
                                                                         const std::vector<double> &torques,
                                                                         const std::vector<int> &cycles,
                                                                         PositionCompliance &compliance) const
  try
    {
      return solve(sliced, torques, cycles, compliance);
    }
  catch (const ComputationError &error)
    {
      std::vector<std::vector<PositionResult>> results(cycles.size());
      for (const double torque : torques)
        {
          std::vector<std::vector<PositionResult>> alone(cycles.size());
          if (torques.size() > 1)
            alone = solve_what_can_be(sliced, { torque }, cycles, compliance);
          else
            for (std::size_t c = 0; c < cycles.size(); ++c)
              {
                PositionResult &none = alone[c].emplace_back();
                none.torque = torque;
                none.phase = sliced.position.phase() + cycles[c];
                none.failure = error.what();
              }
          for (std::size_t c = 0; c < cycles.size(); ++c)
            results[c].push_back(std::move(alone[c].front()));
        }
      return results;
    }

  std::vector<std::vector<PositionResult>> LoadedPair::solve_all(const SlicedPosition &sliced,
                                                                 const std::vector<double> &torques,
                                                                 const std::vector<int> &cycles,
                                                                 PositionCompliance &compliance) const
  {
    std::vector<std::vector<PositionResult>> results(cycles.size(),
                                                     std::vector<PositionResult>(torques.size()));
    for (const auto &band : torque_bands(bodies.pair, torques))
      {
        auto solved = solve_what_can_be(sliced, torques_of_band(torques, band), cycles, compliance);
        for (std::size_t c = 0; c < cycles.size(); ++c)
          for (std::size_t t = 0; t < band.size(); ++t)
            results[c][band[t]] = std::move(solved[c][t]);
      }
    for (std::size_t t = 0; t < torques.size(); ++t)
      for (std::size_t c = 0; torques[t] == 0 && c < cycles.size(); ++c)
        results[c][t] = unloaded(sliced.position.phase(), cycles[c]);
    return results;
  }

  /// By the rule for tilts that are given: what the drive flanks yield by counts for nothing, because the
  /// loaded teeth bend with their coast flanks.
  void LoadedPair::require_free_coast_flanks(const PositionResult &result) const
  {
    if (!coast || result.tilt.isZero(0))
      return;
    const Misalignment by_springs{ .in_plane = result.tilt[2] - result.tilt[0],
                                   .across = result.tilt[3] - result.tilt[1] };
    MeshDeviations tilted = deviations;
    tilted.misalignment.in_plane += by_springs.in_plane;
    tilted.misalignment.across += by_springs.across;
    for (FlankDeviations *flank : { &tilted.pinion, &tilted.gear }) // counted before
      flank->index_errors.clear(), flank->runout = 0;
    const double left = backlash_to_take(bodies.pair) - coast->taken_otherwise;
    if (most_backlash_taken(bodies.pair, tilted).sum() <= left)
      return;
    const double taken = backlash_taken(bodies.pair, tilted, *coast).sum();
    if (taken > left)
      throw ComputationError(fmt::format(
          "the mountings' springs tilt the axes by {:.4g} mrad in the plane of action and {:.4g} mrad "
          "across it at phase {:.4f}, torque {:.6g} N m: all tilts then take {:.4g} um of the "
          "backlash, of which {:.4g} um are left along the normal, and the other flanks would touch, "
          "whose contact is not computed",
          1e3 * by_springs.in_plane, 1e3 * by_springs.across, result.phase,
          result.torque / units::newton_metre, taken / units::micrometre, left / units::micrometre));
  }

  std::vector<PositionResult> LoadedPair::gather(const MeshPosition &position, const int cycle,
                                                 const FittedGrid &fitted) const
  {
    const PositionGrid &grid = fitted.grid;
    const double phase = position.phase() + cycle;
    const Eigen::MatrixXd by_parameter = gap_derivatives(position, grid, n_parameters());
    const auto kept_cells =
        keep_cells && cycle == 0 ? std::make_shared<const std::vector<ContactCell>>(grid.cells()) : nullptr;
    const ContactProblem &problem = grid.problem();
    const GridCells cells = grid_cells_of(bodies.pair, grid);
    SimplexSolver solver(problem);
    std::vector<PositionResult> results;
    for (std::size_t t = 0; t < fitted.solutions.size(); ++t)
      {
        const ContactSolution &solution = fitted.solutions[t];
        const LineContacts contacts = line_contacts(bodies.pair, grid, solution);
        const Turned by = turned(grid, solution, contacts, solver);
        PositionResult &result = results.emplace_back(
            position_result(bodies.pair, phase, grid, solution, contacts, by, fitted.certificates[t], cells));
        require_free_coast_flanks(result);
        if (conditioning && cycle == 0)
          result.condition = condition(problem.compliance(solution.active, solution.active));
        for (const auto &[name, measure] : measures)
          result.measured.push_back(
              { name, measure(bodies.pair, grid.cells(), solution.force, contacts.pressure) });
        if (kept_cells)
          {
            result.contact_cells = kept_cells;
            result.contact_force = solution.force;
            result.contact_gap =
                problem.compliance * solution.force + problem.gap - solution.theta * problem.lever;
          }
        if (n_parameters() > 0)
          {
            const Eigen::VectorXd by_each = by_parameter.transpose() * by.by_gap;
            result.theta_by_parameter = { by_each.begin(), by_each.end() };
          }
      }
    return results;
  }

  std::vector<PositionResult> LoadedPair::solve_cycle(const SlicedPosition &sliced,
                                                      const std::vector<double> &torques, const int cycle,
                                                      PositionCompliance &compliance) const
  {
    std::vector<PositionResult> results(torques.size());
    for (const std::vector<int> &band : torque_bands(bodies.pair, torques))
      solve_on_fitted_grids(bodies, sliced, torques_of_band(torques, band), cycle, compliance,
                            [&](const FittedGrid &fitted) {
                              std::vector<PositionResult> found = gather(sliced.position, cycle, fitted);
                              for (std::size_t k = 0; k < found.size(); ++k)
                                results[band[fitted.torques[k]]] = std::move(found[k]);
                            });
    return results;
  }
} // namespace flank
