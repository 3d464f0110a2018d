// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/loaded_mesh.hpp"

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
    void require_linear(const GearPair &pair, const double phase, const double torque, const double deflection, const double modules = 1)
    {
      if (deflection > modules * pair.data.transverse_module)
        throw ComputationError(fmt::format("a transmission error of {:.4g} mm at phase {:.4f}, torque {:.6g} N m exceeds the module "
                                           "({:.4g} mm): the teeth would leave each other, and "
                                           "linear elasticity holds no longer; lower the torque or check Young's modulus and face width",
                                           deflection, phase, torque, pair.data.transverse_module));
    }

    /// Throws if a solution is not one, or not of linear elasticity.
    void require(const GearPair &pair, const double phase, const ContactSolution &solution, const Certificate &certificate)
    {
      const double torque = solution.torque / units::newton_metre, deflection = pair.pinion.base_radius * solution.theta;
      if (solution.status != Status::solved)
        throw ComputationError(fmt::format("the contact solver found no solution at phase {:.4f}, torque {:.6g} N m ({} pivots)", phase,
                                           torque, solution.pivots));
      if (!certificate.holds())
        throw ComputationError(fmt::format("certificate failed at phase {:.4f}, torque {:.6g} N m: penetration {:.3g}, adhesion {:.3g}, "
                                           "complementarity {:.3g}, balance {:.3g}, allowed {:.3g}",
                                           phase, torque, certificate.penetration, certificate.adhesion, certificate.complementarity,
                                           certificate.balance, certificate.gate));
      require_linear(pair, phase, torque, deflection);
    }

    std::vector<int> most_loaded_first(const ContactSolution &solution)
    {
      std::vector<int> cells = solution.active;
      std::sort(cells.begin(), cells.end(), [&](const int a, const int b) { return solution.force[a] > solution.force[b]; });
      return cells;
    }

    /// Loads of the slices, as points of the contact lines.
    std::vector<LineLoad> line_loads(const GearPair &pair, const PositionGrid &grid, const ContactSolution &solution, const double z_sign)
    {
      std::vector<LineLoad> lines(grid.slices().size());
      std::vector<double>   moment(lines.size(), 0.0), low(lines.size(), 1e300), high(lines.size(), -1e300);
      const double          per_length = std::cos(pair.base_helix_angle), rb = pair.pinion.base_radius;
      for (const int i : solution.active)
        {
          const ContactCell &cell  = grid.cells()[i];
          const Slice       &slice = grid.slices()[cell.slice];
          LineLoad          &line  = lines[cell.slice];
          const double       along = rb / 2 * (cell.pinion.roll * cell.pinion.roll - slice.pinion_roll * slice.pinion_roll);
          line.load_per_length += solution.force[i] * per_length / slice.height;
          line.max_pressure = std::max(line.max_pressure, solution.force[i] / cell.area);
          moment[cell.slice] += solution.force[i] * per_length / slice.height * along;
          low[cell.slice]  = std::min(low[cell.slice], along - cell.pinion.half_profile);
          high[cell.slice] = std::max(high[cell.slice], along + cell.pinion.half_profile);
        }
      for (std::size_t s = 0; s < lines.size(); ++s)
        {
          const Slice &slice   = grid.slices()[s];
          lines[s].pair        = slice.pair;
          lines[s].z           = z_sign * slice.z;
          lines[s].half_width  = std::max(0.0, (high[s] - low[s]) / 2);
          const double centre  = lines[s].load_per_length > 0 ? moment[s] / lines[s].load_per_length : 0;
          lines[s].pinion_roll = std::sqrt(std::max(0.0, slice.pinion_roll * slice.pinion_roll + 2 * centre / rb));
        }
      std::erase_if(lines, [](const LineLoad &line) { return line.load_per_length == 0; });
      return lines;
    }

    GridCells grid_cells(const GearPair &pair, const PositionGrid &grid, const ContactProblem &problem)
    {
      const double          z_sign = canonical_z_sign(pair.data);
      std::vector<GridCell> cells;
      for (std::size_t i = 0; i < grid.cells().size(); ++i)
        {
          const ContactCell &cell = grid.cells()[i];
          cells.push_back(
              { cell.pinion.tooth, z_sign * cell.pinion.z, cell.pinion.roll, cell.gear.roll, cell.area, problem.gap[i], cell.place });
        }
      return std::make_shared<const std::vector<GridCell>>(std::move(cells));
    }

    /// Of the cells' mean gaps by the keys: a row a cell, a column a key. [mm over the key's unit]
    Eigen::MatrixXd gap_derivatives(const MeshPosition &position, const PositionGrid &grid, const std::vector<std::string> &keys)
    {
      Eigen::MatrixXd result(static_cast<Eigen::Index>(grid.cells().size()), static_cast<Eigen::Index>(keys.size()));
      for (Eigen::Index k = 0; k < result.cols(); ++k)
        for (Eigen::Index i = 0; i < result.rows(); ++i)
          {
            const ContactCell &cell = grid.cells()[i];
            result(i, k)            = position.gap_derivative(grid.slices()[cell.slice], cell, keys[k]);
          }
      return result;
    }

    /// Below the slice of the greatest pressure inside the flanks, by all cells of its tooth pair, as half-spaces of each body's material:
    /// the greater of both.
    half_space::SubsurfaceStress below_greatest_pressure(const GearPair &pair, const std::vector<ContactCell> &cells,
                                                         const Eigen::VectorXd &force)
    {
      const ContactCell *most = nullptr;
      double             peak = 0;
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (const double pressure = force[static_cast<Eigen::Index>(i)] / cells[i].area;
            cells[i].place == CellPlace::inside && pressure > peak)
          peak = pressure, most = &cells[i];
      half_space::SubsurfaceStress result;
      if (!most)
        return result;
      const InvoluteHelicoid                   flank = pair.pinion.flank();
      std::vector<half_space::LoadedRectangle> loads;
      std::vector<Eigen::Vector2d>             points;
      double                                   width = 0; // of the loaded cells across the profile
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (const double f = force[static_cast<Eigen::Index>(i)]; f > 0 && cells[i].pinion.tooth == most->pinion.tooth)
          {
            const Patch          &patch = cells[i].pinion;
            const Eigen::Vector2d at    = patch.seen_from(most->pinion, flank);
            loads.push_back({ { at.x(), at.y(), patch.half_profile, patch.half_generator }, f });
            if (cells[i].slice == most->slice)
              {
                points.push_back(at);
                width += 2 * patch.half_profile;
              }
          }
      for (const double nu : { pair.pinion.poissons_ratio, pair.gear.poissons_ratio })
        {
          const auto of_body = half_space::greatest_below(loads, points, width, nu);
          if (of_body.shear > result.shear)
            result.shear = of_body.shear, result.shear_depth = of_body.shear_depth;
          if (of_body.von_mises > result.von_mises)
            result.von_mises = of_body.von_mises, result.von_mises_depth = of_body.von_mises_depth;
          if (pair.pinion.poissons_ratio == pair.gear.poissons_ratio)
            break;
        }
      return result;
    }

    PositionResult gather(const GearPair &pair, const double phase, const PositionGrid &grid, const ContactSolution &solution,
                          const Certificate &certificate, const int grids, const GridCells &grid_cells)
    {
      const double   z_sign = canonical_z_sign(pair.data);
      PositionResult result;
      result.torque      = solution.torque;
      result.phase       = phase;
      result.theta       = solution.theta;
      result.stiffness   = solution.stiffness;
      result.certificate = certificate;
      result.asymmetry   = grid.asymmetry();
      result.cells       = static_cast<int>(grid.cells().size());
      result.pivots      = solution.pivots;
      result.grids       = grids;
      result.tilt        = z_sign * grid.tilt(solution.force);
      result.grid_cells  = grid_cells;
      if (grid_cells)
        result.cell_forces.assign(solution.force.data(), solution.force.data() + solution.force.size());
      std::map<int, PairLoad> loads;
      double                  total = 0;
      for (std::size_t i = 0; i < grid.cells().size(); ++i)
        {
          const ContactCell &cell  = grid.cells()[i];
          const double       force = solution.force[i], pressure = force / cell.area;
          PairLoad          &load = loads.try_emplace(cell.pinion.tooth, PairLoad{ cell.pinion.tooth, 0, 0 }).first->second;
          load.force += force;
          load.max_pressure = std::max(load.max_pressure, pressure);
          total += force;
          result.gear_torque += force * grid.slices()[cell.slice].gear_lever;
          result.shuttling_moment += force * std::cos(pair.base_helix_angle) * z_sign * cell.pinion.z;
          if (cell.place != CellPlace::inside)
            result.edge_pressure = std::max(result.edge_pressure, pressure);
          else if (pressure > result.max_pressure)
            {
              result.max_pressure      = pressure;
              result.max_pressure_roll = cell.pinion.roll;
              result.max_pressure_z    = z_sign * cell.pinion.z;
            }
        }
      if (total > 0)
        result.load_centre = result.shuttling_moment / (total * std::cos(pair.base_helix_angle));
      for (const auto &[k, load] : loads)
        if (load.force > 0)
          result.pairs.push_back(load);
      result.lines = line_loads(pair, grid, solution, z_sign);
      for (const LineLoad &line : result.lines)
        result.max_line_load = std::max(result.max_line_load, line.load_per_length);
      return result;
    }
  } // namespace

  std::vector<std::vector<int>> torque_bands(const std::vector<double> &torques, const int profile_cells)
  {
    // 21 cells serve torques of 4:1: the contact is then half as wide as at the greatest torque.
    const double     ratio = std::max(1.0, 4.0 * profile_cells / 21);
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

  PositionResult LoadedMesh::unloaded(const double phase, const int cycle) const
  {
    PositionResult result;
    result.phase = phase + cycle;
    const MeshPosition position(bodies.pair, deviations, phase);
    const int          slices = 4 * bodies.grid.slices + 1;
    result.theta              = position.first_touch(slices, cycle);
    for (const std::string &key : parameters)
      result.theta_by_parameter.push_back(position.first_touch_derivative(slices, cycle, key));
    return result;
  }

  std::vector<PositionResult> LoadedMesh::solve(const double phase, const std::vector<double> &torques) const
  {
    return solve(phase, torques, { 0 }).front();
  }

  std::vector<std::vector<PositionResult>> LoadedMesh::solve(const double phase, const std::vector<double> &torques,
                                                             const std::vector<int> &cycles) const
  {
    PositionCompliance compliance(bodies.pinion, bodies.gear, bodies.pair.pinion.flank());
    return solve(at(phase), torques, cycles, compliance);
  }

  SlicedPosition LoadedMesh::at(const double phase) const
  {
    const MeshPosition position(bodies.pair, deviations, phase);
    return { position, position.slices(bodies.grid.slices) };
  }

  std::vector<std::vector<PositionResult>> LoadedMesh::solve(const SlicedPosition &sliced, const std::vector<double> &torques,
                                                             const std::vector<int> &cycles, PositionCompliance &compliance) const
  {
    const GearPair     &pair            = bodies.pair;
    const MeshPosition &position        = sliced.position;
    const double        phase           = position.phase();
    const auto          greatest_torque = std::max_element(torques.begin(), torques.end()) - torques.begin();
    const double        torque          = torques[greatest_torque];
    // Reach: a few times the deflection of a mesh of 14 N/(mm um); where the found rotation asks for more, that.
    double reach = 4 * torque / (pair.pinion.base_radius * std::cos(pair.base_helix_angle)) / (pair.common_face_width * 14e3) + 1e-4;
    for (int attempt = 0; attempt < 8; ++attempt)
      {
        PositionGrid grid(bodies, position, compliance, sliced.slices, cycles, torque, reach);
        // One cell a slice is good to some percent: twice the limit is beyond it, and no grid need be built.
        require_linear(pair, phase, torque / units::newton_metre, pair.pinion.base_radius * grid.coarse_rotation(), 2);
        std::vector<std::vector<ContactSolution>> solutions; // [cycle][torque]
        int                                       grids = 0;
        for (bool again = true; again;)
          {
            if (++grids > 12)
              throw ComputationError(
                  fmt::format("the contact grid at phase {:.4f}, {:.6g} N m still ends in a loaded cell after 12 enlargements", phase,
                              torque / units::newton_metre));
            grid.build();
            solutions.clear();
            std::vector<ContactSolution> greatest; // of each cycle
            std::vector<int>             start = grid.expected_contact();
            bool                         wider = false, narrower = false;
            const auto                   fits = [&](const ContactSolution &most) {
              if (most.status != Status::solved)
                return true; // said below
              wider = grid.widen(most) || wider;
              greatest.push_back(most);
              narrower = !wider && grids <= 3 && greatest.size() == cycles.size() && grid.narrow(greatest);
              return !wider && !narrower; // else the other torques wait for the grid that fits
            };
            for (const int cycle : cycles)
              {
                solutions.push_back(SimplexSolver(grid.problem(cycle)).sweep(torques, start, fits));
                const ContactSolution &most = solutions.back()[greatest_torque];
                start                       = most_loaded_first(most);
                if (most.status != Status::solved)
                  break; // said below
              }
            again = greatest.size() == cycles.size() && (wider || narrower);
          }

        const Eigen::MatrixXd by_parameter = gap_derivatives(position, grid, parameters);
        const auto            kept_cells   = keep_cells ? std::make_shared<const std::vector<ContactCell>>(grid.cells()) : nullptr;
        std::vector<std::vector<PositionResult>> results;
        double                                   overlap = 0;
        for (std::size_t c = 0; c < solutions.size(); ++c)
          {
            const ContactProblem &problem = grid.problem(cycles[c]);
            const GridCells       cells   = c == 0 ? grid_cells(pair, grid, problem) : nullptr;
            results.emplace_back();
            for (const ContactSolution &solution : solutions[c])
              {
                const Certificate certificate = certify(problem, solution);
                require(pair, phase + cycles[c], solution, certificate);
                results.back().push_back(gather(pair, phase + cycles[c], grid, solution, certificate, grids, cells));
                if (subsurface_stress)
                  results.back().back().subsurface = below_greatest_pressure(pair, grid.cells(), solution.force);
                if (keep_cells)
                  {
                    PositionResult &result = results.back().back();
                    result.contact_cells   = kept_cells;
                    result.contact_force   = solution.force;
                    result.contact_gap     = problem.compliance * solution.force + problem.gap - solution.theta * problem.lever;
                  }
                if (!parameters.empty())
                  {
                    const Eigen::VectorXd by_gap             = SimplexSolver(problem).sensitivities(solution).theta_by_gap,
                                          by_key             = by_parameter.transpose() * by_gap;
                    results.back().back().theta_by_parameter = { by_key.begin(), by_key.end() };
                  }
                overlap = std::max(overlap, grid.overlap_left_out(cycles[c], solution));
              }
          }
        if (overlap == 0)
          return results;
        reach = std::max(1.6 * reach, reach + 1.1 * overlap);
      }
    throw ComputationError(fmt::format("tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}", reach, phase));
  }
} // namespace flank
