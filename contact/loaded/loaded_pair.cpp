// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/loaded_pair.hpp"

#include "contact/loaded/grid_certificate.hpp"
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

  std::vector<std::vector<int>> torque_bands(const std::vector<double> &torques, const int profile_cells)
  {
    // 21 cells serve torques of 4:1: the contact is then half as wide as at the greatest torque.
    const double ratio = std::max(1.0, 4.0 * profile_cells / 21);
    std::vector<int> order;
    for (std::size_t i = 0; i < torques.size(); ++i)
      if (torques[i] > 0)
        order.push_back(static_cast<int>(i));
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return torques[a] > torques[b]; });
    std::vector<std::vector<int>> bands;
    for (const int i : order)
      {
        if (bands.empty() || torques[i] * ratio < torques[bands.back().front()] * (1 - 1e-12))
          bands.emplace_back();
        bands.back().push_back(i);
      }
    return bands;
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
    PositionCompliance compliance(bodies.pinion, bodies.gear, bodies.pair.pinion.flank());
    return solve(at(phase), torques, cycles, compliance);
  }

  SlicedPosition LoadedPair::at(const double phase) const
  {
    const MeshPosition position(bodies.pair, deviations, phase);
    return { position, position.slices(bodies.grid.slices) };
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
    for (const auto &band : torque_bands(torques, bodies.grid.profile_cells))
      {
        std::vector<double> of_band;
        for (const int t : band)
          of_band.push_back(torques[t]);
        auto solved = solve_what_can_be(sliced, of_band, cycles, compliance);
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
    /// The grid is built again until its windows enclose the contact at every torque and resolve it at the
    /// greatest. Returns how many it took.
    int fit_windows(PositionGrid &grid, const std::vector<double> &torques, const std::size_t greatest,
                    std::vector<ContactSolution> &solutions)
    {
      constexpr int most_grids = 64, most_narrowed = 3,
                    most_resolved = 8; // windows that only widen reach the flank's edges after some 25
      int resolved = 0;
      for (int grids = 1;; ++grids)
        {
          grid.build();
          bool again = false;
          const auto fits = [&](const ContactSolution &most) {
            if (most.status == Status::solved) // else said by the certificate
              again = grid.widen(most) || (grids <= most_narrowed && grid.narrow(most)) ||
                      (resolved < most_resolved && grid.resolve(most) && ++resolved);
            again = again && grids < most_grids; // else the certificate says what is wrong with it
            return !again;                       // else the other torques wait for the grid that fits
          };
          solutions = SimplexSolver(grid.problem()).sweep(torques, grid.expected_contact(), fits);
          for (std::size_t t = 0; t < torques.size() && !again; ++t)
            again = t != greatest && solutions[t].status == Status::solved && grids < most_grids &&
                    grid.widen(solutions[t]);
          if (!again)
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
    const GearPair &pair = bodies.pair;
    const MeshPosition &position = sliced.position;
    const double phase = position.phase() + cycle;
    const auto greatest = std::max_element(torques.begin(), torques.end()) - torques.begin();
    const double torque = torques[greatest];
    double reach = first_reach(pair, torque);
    for (int attempt = 0; attempt < 8; ++attempt)
      {
        PositionGrid grid(bodies, position, compliance, sliced.slices, cycle, torque, reach);
        // One cell a slice is good to some percent: twice the limit is beyond it, and no grid need be built.
        require_linear(pair, phase, torque / units::newton_metre,
                       pair.pinion.base_radius * grid.coarse_rotation(), 2);
        std::vector<ContactSolution> solutions;
        const int grids = fit_windows(grid, torques, greatest, solutions);

        double overlap = 0;
        std::vector<Certificate> certificates;
        for (const ContactSolution &solution : solutions)
          {
            certificates.push_back(certify(grid.problem(), solution));
            require(pair, phase, solution, certificates.back());
            overlap = std::max(overlap, grid.overlap_left_out(solution));
          }
        if (overlap == 0)
          {
            // Torques below the greatest for which this grid is too coarse get one of their own.
            std::vector<std::size_t> left;
            std::vector<double> lower;
            for (std::size_t t = 0; t < torques.size(); ++t)
              {
                const GridCertificate covered =
                    certify_grid(bodies, position, cycle, sliced.slices, grid.cells(), solutions[t].force,
                                 solutions[t].theta);
                if (covered.holds() || torques[t] == torque)
                  require(phase, solutions[t], covered);
                else
                  {
                    left.push_back(t);
                    lower.push_back(torques[t]);
                  }
              }
            std::vector<PositionResult> results =
                gather_all(sliced, cycle, grid, solutions, certificates, grids);
            if (!lower.empty())
              {
                std::vector<PositionResult> finer = solve_cycle(sliced, lower, cycle, compliance);
                for (std::size_t k = 0; k < left.size(); ++k)
                  results[left[k]] = std::move(finer[k]);
              }
            return results;
          }
        reach = std::max(1.6 * reach, reach + 1.1 * overlap);
      }
    throw ComputationError(
        fmt::format("tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}", reach, phase));
  }
} // namespace flank
