// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/loaded_pair.hpp"

#include "contact/loaded/grid_certificate.hpp"
#include "contact/solve/conditioning.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace flank
{
  namespace
  {
    /// Throws where the teeth would leave each other. [N m, mm]
    void require_linear(const GearPair &pair, const double phase, const double torque,
                        const double deflection, const double modules = 1)
    {
      if (deflection > modules * pair.data.transverse_module)
        throw ComputationError(fmt::format(
            "a transmission error of {:.4g} mm at phase {:.4f}, torque {:.6g} N m exceeds the module "
            "({:.4g} mm): the teeth would leave each other, and "
            "linear elasticity holds no longer; lower the torque or check Young's modulus and face width",
            deflection, phase, torque, pair.data.transverse_module));
    }

    /// Throws if a solution is not one, or not of linear elasticity.
    void require(const GearPair &pair, const double phase, const ContactSolution &solution,
                 const Certificate &certificate)
    {
      const double torque = solution.torque / units::newton_metre,
                   deflection = pair.pinion.base_radius * solution.theta;
      if (solution.status != Status::solved)
        throw ComputationError(
            fmt::format("the contact solver found no solution at phase {:.4f}, torque {:.6g} N m ({} pivots)",
                        phase, torque, solution.pivots));
      if (!certificate.holds())
        throw ComputationError(fmt::format(
            "certificate failed at phase {:.4f}, torque {:.6g} N m: penetration {:.3g}, adhesion {:.3g}, "
            "complementarity {:.3g}, balance {:.3g}, allowed {:.3g}",
            phase, torque, certificate.penetration, certificate.adhesion, certificate.complementarity,
            certificate.balance, certificate.gate));
      require_linear(pair, phase, torque, deflection);
    }

    /// Throws if the cells under a solution do not cover or resolve the contact.
    void require(const double phase, const ContactSolution &solution, const GridCertificate &certificate)
    {
      if (!certificate.holds())
        throw ComputationError(
            fmt::format("the contact grid failed its certificate at phase {:.4f}, torque {:.6g} N m: {}",
                        phase, solution.torque / units::newton_metre, certificate.describe()));
    }

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
  } // namespace

  namespace
  {
    /// Octaves of torque are counted in it: the same ones for pairs of another size or stiffness. [N mm]
    double torque_unit(const GearPair &pair)
    {
      return effective_modulus(pair) * std::pow(pair.data.transverse_module, 2) * pair.common_face_width;
    }

    double octave_of(const GearPair &pair, const double torque)
    {
      return std::floor(std::log2(torque / torque_unit(pair)));
    }

    /// What the grid of a torque is sized for, whatever other torques are computed: most torques of the
    /// octave then neither widen nor narrow it. [N mm]
    double sizing_torque(const GearPair &pair, const double torque)
    {
      return torque_unit(pair) * std::exp2(octave_of(pair, torque) + 0.75);
    }
  } // namespace

  std::vector<std::vector<int>> torque_bands(const GearPair &pair, const std::vector<double> &torques)
  {
    std::map<double, std::vector<int>> by_octave;
    for (std::size_t i = 0; i < torques.size(); ++i)
      if (torques[i] > 0)
        by_octave[-octave_of(pair, torques[i])].push_back(static_cast<int>(i));
    std::vector<std::vector<int>> bands;
    for (auto &[octave, band] : by_octave)
      {
        std::stable_sort(band.begin(), band.end(), [&](int a, int b) { return torques[a] > torques[b]; });
        bands.push_back(std::move(band));
      }
    return bands;
  }

  std::vector<double> torques_of_band(const std::vector<double> &torques, const std::vector<int> &band)
  {
    std::vector<double> of_band;
    for (const int t : band)
      of_band.push_back(torques[t]);
    return of_band;
  }

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
    const MeshPosition position(bodies.pair, deviations, phase);
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
    const MeshPosition position(bodies.pair, deviations, phase);
    auto [slices, undivided] = position.slices_finer_at_corners(bodies.grid.slices);
    return { position, std::move(slices), undivided, bodies.pair.common_face_width / bodies.grid.slices };
  }

  std::vector<std::vector<PositionResult>> LoadedPair::solve(const SlicedPosition &sliced,
                                                             const std::vector<double> &torques,
                                                             const std::vector<int> &cycles,
                                                             PositionCompliance &compliance) const
  {
    std::vector<std::vector<PositionResult>> results;
    std::map<std::vector<double>, std::size_t> solved; // by how far the pairs stand back
    for (const int cycle : cycles)
      {
        std::vector<double> stand_back;
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

  namespace
  {
    /// The grid is built again until its windows enclose the contact at a torque and resolve it. Returns how
    /// many it took.
    int fit_windows(PositionGrid &grid, const double torque, ContactSolution &solution)
    {
      constexpr int most_grids = 64, most_narrowed = 3,
                    most_resolved = 8; // windows that only widen reach the flank's edges after some 25
      int resolved = 0;
      for (int grids = 1;; ++grids)
        {
          grid.build();
          solution = SimplexSolver(grid.problem()).sweep({ torque }, grid.expected_contact()).front();
          if (solution.status != Status::solved || grids == most_grids)
            return grids; // the certificates say what is wrong
          if (!(grid.widen(solution) || (grids <= most_narrowed && grid.narrow(solution)) ||
                (resolved < most_resolved && grid.resolve(solution) && ++resolved)))
            return grids;
        }
    }
  } // namespace

  std::vector<PositionResult> LoadedPair::gather_all(const SlicedPosition &sliced, const int cycle,
                                                     const PositionGrid &grid,
                                                     const std::vector<ContactSolution> &solutions,
                                                     const std::vector<Certificate> &certificates,
                                                     const int grids) const
  {
    const double phase = sliced.position.phase() + cycle;
    const Eigen::MatrixXd by_parameter = gap_derivatives(sliced.position, grid, n_parameters());
    const auto kept_cells =
        keep_cells ? std::make_shared<const std::vector<ContactCell>>(grid.cells()) : nullptr;
    const ContactProblem &problem = grid.problem();
    const GridCells cells = grid_cells_of(bodies.pair, grid);
    std::vector<PositionResult> results;
    for (std::size_t t = 0; t < solutions.size(); ++t)
      {
        const ContactSolution &solution = solutions[t];
        PositionResult &result = results.emplace_back(
            position_result(bodies.pair, phase, grid, solution, certificates[t], grids, cells));
        if (conditioning && cycle == 0)
          result.condition = condition(problem.compliance(solution.active, solution.active));
        if (subsurface_stress)
          result.subsurface = below_greatest_pressure(bodies.pair, grid.cells(), solution.force);
        if (keep_cells)
          {
            result.contact_cells = kept_cells;
            result.contact_force = solution.force;
            result.contact_gap =
                problem.compliance * solution.force + problem.gap - solution.theta * problem.lever;
          }
        if (n_parameters() > 0)
          {
            const Eigen::VectorXd by_gap = SimplexSolver(problem).sensitivities(solution).theta_by_gap,
                                  by_each = by_parameter.transpose() * by_gap;
            result.theta_by_parameter = { by_each.begin(), by_each.end() };
          }
      }
    return results;
  }

  namespace
  {
    /// How far apart flanks may be that could touch [mm]: a few times the deflection of a mesh, of 14 N/(mm
    /// um) for steel, and 3e-5 of the module; where the found rotation asks for more, that is taken.
    double first_reach(const GearPair &pair, const double torque)
    {
      const double stiffness = 0.123 * effective_modulus(pair) * pair.common_face_width;
      return 4 * torque / (pair.pinion.base_radius * std::cos(pair.base_helix_angle)) / stiffness +
             pair.data.transverse_module / 3e4;
    }
  } // namespace

  std::vector<PositionResult> LoadedPair::solve_cycle(const SlicedPosition &sliced,
                                                      const std::vector<double> &torques, const int cycle,
                                                      PositionCompliance &compliance) const
  {
    std::vector<PositionResult> results(torques.size());
    for (const std::vector<int> &band : torque_bands(bodies.pair, torques))
      {
        const std::vector<double> of_band = torques_of_band(torques, band);
        auto together = solve_together(sliced, of_band, cycle, compliance);
        for (std::size_t t = 0; t < band.size(); ++t)
          results[band[t]] =
              together[t] ? std::move(*together[t]) : solve_alone(sliced, of_band[t], cycle, compliance);
      }
    return results;
  }

  std::vector<std::optional<PositionResult>> LoadedPair::solve_together(const SlicedPosition &sliced,
                                                                        const std::vector<double> &torques,
                                                                        const int cycle,
                                                                        PositionCompliance &compliance) const
  {
    std::vector<std::optional<PositionResult>> results(torques.size());
    if (torques.size() == 1)
      return results; // this grid is the first that it is tried on alone
    const GearPair &pair = bodies.pair;
    const double size = sizing_torque(pair, torques.front());
    const SlicesInReach slices = sliced.in_reach(first_reach(pair, 1.2 * size));
    PositionGrid grid(bodies, sliced.position, compliance, slices, cycle, size);
    grid.build();
    const std::vector<ContactSolution> all =
        SimplexSolver(grid.problem()).sweep(torques, grid.expected_contact());
    std::vector<std::size_t> fitting;
    std::vector<ContactSolution> solutions;
    std::vector<Certificate> certificates;
    for (std::size_t t = 0; t < torques.size(); ++t)
      if (all[t].status == Status::solved && grid.fits(all[t]) && !grid.finer(all[t]) &&
          grid.overlap_left_out(all[t]) == 0 &&
          certify_grid(bodies, sliced.position, cycle, slices.all, grid.cells(), all[t].force, all[t].theta)
              .holds())
        {
          fitting.push_back(t);
          solutions.push_back(all[t]);
          certificates.push_back(certify(grid.problem(), all[t]));
          require(pair, sliced.position.phase() + cycle, all[t], certificates.back());
        }
    std::vector<PositionResult> gathered = gather_all(sliced, cycle, grid, solutions, certificates, 1);
    for (std::size_t k = 0; k < fitting.size(); ++k)
      results[fitting[k]] = std::move(gathered[k]);
    return results;
  }

  PositionResult LoadedPair::solve_alone(const SlicedPosition &sliced, const double torque, const int cycle,
                                         PositionCompliance &compliance) const
  {
    const GearPair &pair = bodies.pair;
    const MeshPosition &position = sliced.position;
    const double phase = position.phase() + cycle, size = sizing_torque(pair, torque);
    SlicesInReach slices = sliced.in_reach(first_reach(pair, 1.2 * size));
    for (int attempt = 0; attempt < 24; ++attempt)
      {
        PositionGrid grid(bodies, position, compliance, slices, cycle, size);
        // One cell a slice is good to some percent, and the size is within 1.7 times the torque: four times
        // the limit is beyond it, and no grid need be built.
        require_linear(pair, phase, torque / units::newton_metre,
                       pair.pinion.base_radius * grid.coarse_rotation(), 4);
        ContactSolution solution;
        const int grids = fit_windows(grid, torque, solution);
        const Certificate certificate = certify(grid.problem(), solution);
        require(pair, phase, solution, certificate);
        if (grid.overlap_left_out(solution) > 0)
          slices = grid.further(solution);
        else if (std::optional<SlicesInReach> finer = grid.finer(solution))
          slices = std::move(*finer);
        else
          {
            require(phase, solution,
                    certify_grid(bodies, position, cycle, slices.all, grid.cells(), solution.force,
                                 solution.theta));
            return gather_all(sliced, cycle, grid, { solution }, { certificate }, grids).front();
          }
      }
    throw ComputationError(fmt::format(
        "tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}", slices.reach, phase));
  }
} // namespace flank
