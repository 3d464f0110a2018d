// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/loaded_mesh.hpp"

#include "contact/half_space/half_space.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace flank
{
  namespace
  {
    /// The contact problem on a set of cells.
    ContactProblem assemble(const LoadedMesh &mesh, const std::vector<ContactCell> &cells, double &asymmetry)
    {
      std::vector<Patch> pinion, gear;
      ContactProblem     problem;
      problem.gap.resize(cells.size());
      problem.lever.resize(cells.size());
      for (std::size_t i = 0; i < cells.size(); ++i)
        {
          pinion.push_back(cells[i].pinion);
          gear.push_back(cells[i].gear);
          problem.gap[i]   = cells[i].gap;
          problem.lever[i] = cells[i].lever;
        }
      double of_pinion, of_gear;
      problem.compliance = mesh.pinion.between(pinion, of_pinion);
      problem.compliance += mesh.gear.between(gear, of_gear);
      asymmetry = std::max(of_pinion, of_gear);
      return problem;
    }

    /// Half-width of the Hertz line contact under a load per length. [mm]
    double hertz_half_width(const double load_per_length, const double radius, const double effective_modulus)
    {
      return std::sqrt(4 * load_per_length * radius / (units::pi * effective_modulus));
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

  PositionResult LoadedMesh::unloaded(const double phase) const
  {
    PositionResult result;
    result.phase = phase;
    result.theta = MeshPosition(pair, pinion_modifications, gear_modifications, phase).first_touch(4 * grid.slices + 1);
    return result;
  }

  std::vector<PositionResult> LoadedMesh::solve(const double phase, const std::vector<double> &torques) const
  {
    const MeshPosition position(pair, pinion_modifications, gear_modifications, phase);
    const double       torque = *std::max_element(torques.begin(), torques.end());
    const double       cos_bb = std::cos(pair.base_helix_angle), normal_load = torque / (pair.pinion.base_radius * cos_bb);
    const auto         plane  = [](const Gear &g) { return (1 - g.poissons_ratio * g.poissons_ratio) / g.youngs_modulus; };
    const double       modulus = 1 / (plane(pair.pinion) + plane(pair.gear));
    const double       z_sign  = canonical_z_sign(pair.data);

    // Reach: a few times the deflection of a mesh of 14 N/(mm um), enlarged below if the solution asks for it.
    double reach = 4 * normal_load / (pair.common_face_width * 14e3) + 1e-4;
    for (int attempt = 0; attempt < 8; ++attempt, reach *= 1.6)
      {
        const std::vector<Slice> slices = position.slices(grid.slices, reach);
        const auto               face_end = [&](const Slice &s) { return std::abs(s.z) + 0.51 * s.height > pair.common_face_width / 2; };

        // One cell a slice first: which slice carries what, so that every window can follow its own load.
        std::vector<double> half_width(slices.size());
        double              asymmetry;
        const double        mean_load = normal_load * cos_bb / (pair.common_face_width * std::max(1.0, std::min(pair.total_contact_ratio(), 1.0 * slices.size() / grid.slices)));
        {
          std::vector<ContactCell> cells;
          for (std::size_t s = 0; s < slices.size(); ++s)
            position.add_cells(slices[s], static_cast<int>(s), units::pi / 4 * hertz_half_width(mean_load, position.relative_radius(slices[s]), modulus), 1, face_end(slices[s]), cells);
          const ContactProblem  problem = assemble(*this, cells, asymmetry);
          const ContactSolution coarse  = SimplexSolver(problem).solve(torque);
          std::vector<double>   load(slices.size(), 0.0);
          for (std::size_t i = 0; i < cells.size(); ++i)
            load[cells[i].slice] += coarse.force[i] * cos_bb / slices[cells[i].slice].height;
          for (std::size_t s = 0; s < slices.size(); ++s)
            {
              // The greatest of the slice and its neighbours on the same tooth pair; never less than a tenth of the mean load.
              double line = 0.1 * mean_load;
              for (std::size_t t = s > 0 ? s - 1 : 0; t <= s + 1 && t < slices.size(); ++t)
                if (slices[t].pair == slices[s].pair)
                  line = std::max(line, load[t]);
              half_width[s] = 1.45 * hertz_half_width(line, position.relative_radius(slices[s]), modulus);
            }
        }

        std::vector<ContactSolution> solutions;
        std::vector<ContactCell>     cells;
        ContactProblem               problem;
        int                          grids = 0;
        for (bool enclosed = false; !enclosed;)
          {
            if (++grids > 8)
              throw ComputationError(fmt::format("the contact grid at phase {:.4f}, {:.6g} N m still ends in a loaded cell after 8 enlargements", phase, torque / units::newton_metre));
            cells.clear();
            for (std::size_t s = 0; s < slices.size(); ++s)
              position.add_cells(slices[s], static_cast<int>(s), half_width[s], grid.profile_cells, face_end(slices[s]), cells);
            problem   = assemble(*this, cells, asymmetry);
            solutions = SimplexSolver(problem).sweep(torques);
            enclosed  = true;
            const auto &greatest = *std::max_element(solutions.begin(), solutions.end(), [](const auto &a, const auto &b) { return a.torque < b.torque; });
            for (std::size_t i = 0; i < cells.size(); ++i)
              if (cells[i].window_border && greatest.force[i] > 0)
                {
                  enclosed                  = false;
                  half_width[cells[i].slice] *= 1.35;
                }
            // The most loaded slice inside the flanks must spread over about five cells of eleven, or all windows shrink.
            if (enclosed && grids <= 3)
              {
                std::vector<double> line(slices.size(), 0.0);
                std::vector<int>    loaded(slices.size(), 0);
                for (std::size_t i = 0; i < cells.size(); ++i)
                  if (!slices[cells[i].slice].tip_edge && greatest.force[i] > 0)
                    {
                      line[cells[i].slice] += greatest.force[i];
                      ++loaded[cells[i].slice];
                    }
                const auto most = std::max_element(line.begin(), line.end()) - line.begin();
                if (line[most] > 0 && 11 * loaded[most] < 5 * grid.profile_cells)
                  {
                    enclosed = false;
                    for (double &width : half_width)
                      width *= 0.7;
                  }
              }
          }

        // Slices left out must still be apart under the found rotation.
        bool complete = true;
        for (const Slice &slice : position.slices(grid.slices, 1e300))
          for (const ContactSolution &solution : solutions)
            if (std::none_of(slices.begin(), slices.end(), [&](const Slice &s) { return s.pair == slice.pair && s.z == slice.z; }) &&
                position.modified_separation(slice) < solution.theta * slice.lever)
              complete = false;
        if (!complete)
          continue;

        std::vector<PositionResult> results;
        for (const ContactSolution &solution : solutions)
          {
            PositionResult result;
            result.torque      = solution.torque;
            result.phase       = phase;
            result.theta       = solution.theta;
            result.stiffness   = solution.stiffness;
            result.certificate = certify(problem, solution);
            result.asymmetry   = asymmetry;
            result.cells       = static_cast<int>(cells.size());
            result.pivots      = solution.pivots;
            result.grids       = grids;
            if (!result.certificate.holds())
              throw ComputationError(fmt::format("certificate failed at phase {:.4f}, torque {:.6g} N m: penetration {:.3g}, adhesion {:.3g}, complementarity {:.3g}, balance {:.3g}, allowed {:.3g}",
                                                 phase, solution.torque / units::newton_metre, result.certificate.penetration, result.certificate.adhesion,
                                                 result.certificate.complementarity, result.certificate.balance, result.certificate.gate));
            std::map<int, PairLoad> loads;
            for (std::size_t i = 0; i < cells.size(); ++i)
              {
                const ContactCell &cell     = cells[i];
                const double       pressure = solution.force[i] / cell.area;
                PairLoad          &load     = loads.try_emplace(cell.pinion.tooth, PairLoad{cell.pinion.tooth, 0, 0}).first->second;
                load.force += solution.force[i];
                load.max_pressure = std::max(load.max_pressure, pressure);
                result.gear_torque += solution.force[i] * slices[cell.slice].gear_lever;
                if (cell.edge)
                  result.edge_pressure = std::max(result.edge_pressure, pressure);
                else if (pressure > result.max_pressure)
                  {
                    result.max_pressure      = pressure;
                    result.max_pressure_roll = cell.pinion.roll;
                    result.max_pressure_z    = z_sign * cell.pinion.z;
                  }
                result.cell_results.push_back({cell.pinion.tooth, z_sign * cell.pinion.z, cell.pinion.roll, cell.gear.roll, cell.area, cell.gap, solution.force[i], cell.edge});
              }
            for (const auto &[k, load] : loads)
              if (load.force > 0)
                result.pairs.push_back(load);
            results.push_back(std::move(result));
          }
        return results;
      }
    throw ComputationError(fmt::format("tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}", reach, phase));
  }
} // namespace flank
