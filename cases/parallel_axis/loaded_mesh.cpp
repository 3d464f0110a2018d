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

    /// One position's grid for torques up to `torque`: slices, the half-width of every slice's window, cells and problem.
    class PositionGrid
    {
    public:
      PositionGrid(const LoadedMesh &mesh, const MeshPosition &position, const double torque, const double reach)
          : mesh_(mesh)
          , position_(position)
          , torque_(torque)
          , slices_(position.slices(mesh.grid.slices, reach))
      {
        const auto plane = [](const Gear &g) { return (1 - g.poissons_ratio * g.poissons_ratio) / g.youngs_modulus; };
        modulus_         = 1 / (plane(mesh.pair.pinion) + plane(mesh.pair.gear));
        size_windows();
      }

      const std::vector<Slice>       &slices() const { return slices_; }
      const std::vector<ContactCell> &cells() const { return cells_; }
      const ContactProblem           &problem() const { return problem_; }
      double                          asymmetry() const { return asymmetry_; }

      /// Cells and problem for the present windows.
      void build()
      {
        cells_.clear();
        for (std::size_t s = 0; s < slices_.size(); ++s)
          position_.add_cells(slices_[s], static_cast<int>(s), half_width_[s], mesh_.grid.profile_cells, face_end(slices_[s]), cells_);
        problem_ = assemble(mesh_, cells_, asymmetry_);
      }

      /// Widens the windows that end in a loaded cell; false if there is none.
      bool widen(const Eigen::VectorXd &force)
      {
        bool widened = false;
        for (std::size_t i = 0; i < cells_.size(); ++i)
          if (cells_[i].window_border && force[i] > 0)
            {
              half_width_[cells_[i].slice] *= 1.35;
              widened = true;
            }
        return widened;
      }

      /// The most loaded slice inside the flanks must spread over about five cells of eleven: narrows all windows if not.
      bool narrow(const Eigen::VectorXd &force)
      {
        std::vector<double> load(slices_.size(), 0.0);
        std::vector<int>    loaded(slices_.size(), 0);
        for (std::size_t i = 0; i < cells_.size(); ++i)
          if (!slices_[cells_[i].slice].tip_edge && force[i] > 0)
            {
              load[cells_[i].slice] += force[i];
              ++loaded[cells_[i].slice];
            }
        const auto most = std::max_element(load.begin(), load.end()) - load.begin();
        if (load[most] == 0 || 11 * loaded[most] >= 5 * mesh_.grid.profile_cells)
          return false;
        for (double &width : half_width_)
          width *= 0.7;
        return true;
      }

    private:
      bool face_end(const Slice &slice) const { return std::abs(slice.z) + 0.51 * slice.height > mesh_.pair.common_face_width / 2; }

      /// One cell a slice first: which slice carries what, so that every window can follow its own load.
      void size_windows()
      {
        const double cos_bb    = std::cos(mesh_.pair.base_helix_angle);
        const double covered   = std::min(mesh_.pair.total_contact_ratio(), 1.0 * slices_.size() / mesh_.grid.slices);
        const double mean_load = torque_ / (mesh_.pair.pinion.base_radius * mesh_.pair.common_face_width * std::max(1.0, covered));
        for (std::size_t s = 0; s < slices_.size(); ++s)
          position_.add_cells(slices_[s], static_cast<int>(s),
                              units::pi / 4 * hertz_half_width(mean_load, position_.relative_radius(slices_[s]), modulus_), 1,
                              face_end(slices_[s]), cells_);
        problem_                     = assemble(mesh_, cells_, asymmetry_);
        const ContactSolution coarse = SimplexSolver(problem_).solve(torque_);
        std::vector<double>   load(slices_.size(), 0.0);
        for (std::size_t i = 0; i < cells_.size(); ++i)
          load[cells_[i].slice] += coarse.force[i] * cos_bb / slices_[cells_[i].slice].height;
        half_width_.resize(slices_.size());
        for (std::size_t s = 0; s < slices_.size(); ++s)
          {
            // The greatest of the slice and its neighbours on the same tooth pair; never less than a tenth of the mean load.
            double line = 0.1 * mean_load;
            for (std::size_t t = s > 0 ? s - 1 : 0; t <= s + 1 && t < slices_.size(); ++t)
              if (slices_[t].pair == slices_[s].pair)
                line = std::max(line, load[t]);
            half_width_[s] = 1.45 * hertz_half_width(line, position_.relative_radius(slices_[s]), modulus_);
          }
      }

      const LoadedMesh        &mesh_;
      const MeshPosition      &position_;
      double                   torque_, modulus_ = 0, asymmetry_ = 0;
      std::vector<Slice>       slices_;
      std::vector<double>      half_width_;
      std::vector<ContactCell> cells_;
      ContactProblem           problem_;
    };

    /// Greatest approach beyond first touch, modified surfaces, that a slice left out of `grid` would see. [mm]
    double overlap_left_out(const MeshPosition &position, const PositionGrid &grid, const int per_face_width, const double theta)
    {
      double overlap = 0;
      for (const Slice &slice : position.slices(per_face_width, 1e300))
        if (std::none_of(grid.slices().begin(), grid.slices().end(),
                         [&](const Slice &s) { return s.pair == slice.pair && s.z == slice.z; }))
          overlap = std::max(overlap, theta * slice.lever - position.modified_separation(slice));
      return overlap;
    }

    /// Throws if a solution is not one, or not of linear elasticity.
    void require(const LoadedMesh &mesh, const double phase, const ContactSolution &solution, const Certificate &certificate)
    {
      const double torque = solution.torque / units::newton_metre, deflection = mesh.pair.pinion.base_radius * solution.theta;
      if (solution.status != Status::solved)
        throw ComputationError(fmt::format("the contact solver found no solution at phase {:.4f}, torque {:.6g} N m ({} pivots)", phase,
                                           torque, solution.pivots));
      if (!certificate.holds())
        throw ComputationError(fmt::format("certificate failed at phase {:.4f}, torque {:.6g} N m: penetration {:.3g}, adhesion {:.3g}, "
                                           "complementarity {:.3g}, balance {:.3g}, allowed {:.3g}",
                                           phase, torque, certificate.penetration, certificate.adhesion, certificate.complementarity,
                                           certificate.balance, certificate.gate));
      if (deflection > mesh.pair.data.transverse_module)
        throw ComputationError(fmt::format("a transmission error of {:.4g} mm at phase {:.4f}, torque {:.6g} N m exceeds the module "
                                           "({:.4g} mm): the teeth would leave each other, and "
                                           "linear elasticity holds no longer; lower the torque or check Young's modulus and face width",
                                           deflection, phase, torque, mesh.pair.data.transverse_module));
    }

    PositionResult gather(const LoadedMesh &mesh, const double phase, const PositionGrid &grid, const ContactSolution &solution,
                          const Certificate &certificate, const int grids)
    {
      const double   z_sign = canonical_z_sign(mesh.pair.data);
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
      std::map<int, PairLoad> loads;
      for (std::size_t i = 0; i < grid.cells().size(); ++i)
        {
          const ContactCell &cell     = grid.cells()[i];
          const double       pressure = solution.force[i] / cell.area;
          PairLoad          &load     = loads.try_emplace(cell.pinion.tooth, PairLoad{ cell.pinion.tooth, 0, 0 }).first->second;
          load.force += solution.force[i];
          load.max_pressure = std::max(load.max_pressure, pressure);
          result.gear_torque += solution.force[i] * grid.slices()[cell.slice].gear_lever;
          if (cell.edge)
            result.edge_pressure = std::max(result.edge_pressure, pressure);
          else if (pressure > result.max_pressure)
            {
              result.max_pressure      = pressure;
              result.max_pressure_roll = cell.pinion.roll;
              result.max_pressure_z    = z_sign * cell.pinion.z;
            }
          result.cell_results.push_back({ cell.pinion.tooth, z_sign * cell.pinion.z, cell.pinion.roll, cell.gear.roll, cell.area, cell.gap,
                                          solution.force[i], cell.edge });
        }
      for (const auto &[k, load] : loads)
        if (load.force > 0)
          result.pairs.push_back(load);
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
    // Reach: a few times the deflection of a mesh of 14 N/(mm um); where the found rotation asks for more, that.
    double reach = 4 * torque / (pair.pinion.base_radius * std::cos(pair.base_helix_angle)) / (pair.common_face_width * 14e3) + 1e-4;
    for (int attempt = 0; attempt < 8; ++attempt)
      {
        PositionGrid                 grid(*this, position, torque, reach);
        std::vector<ContactSolution> solutions;
        int                          grids = 0;
        for (bool again = true; again;)
          {
            if (++grids > 8)
              throw ComputationError(
                  fmt::format("the contact grid at phase {:.4f}, {:.6g} N m still ends in a loaded cell after 8 enlargements", phase,
                              torque / units::newton_metre));
            grid.build();
            solutions = SimplexSolver(grid.problem()).sweep(torques);
            const auto &greatest =
                *std::max_element(solutions.begin(), solutions.end(), [](const auto &a, const auto &b) { return a.torque < b.torque; });
            again = grid.widen(greatest.force) || (grids <= 3 && grid.narrow(greatest.force));
          }

        std::vector<PositionResult> results;
        double                      overlap = 0;
        for (const ContactSolution &solution : solutions)
          {
            const Certificate certificate = certify(grid.problem(), solution);
            require(*this, phase, solution, certificate);
            results.push_back(gather(*this, phase, grid, solution, certificate, grids));
            overlap = std::max(overlap, overlap_left_out(position, grid, this->grid.slices, solution.theta));
          }
        if (overlap == 0)
          return results;
        reach = std::max(1.6 * reach, reach + 1.1 * overlap);
      }
    throw ComputationError(fmt::format("tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}", reach, phase));
  }
} // namespace flank
