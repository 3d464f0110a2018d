// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/fitted_grids.hpp"

#include "contact/loaded/grid_certificate.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace flank
{
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

    /// How far apart flanks may be that could touch [mm]: a few times the deflection of a mesh, of 14 N/(mm
    /// um) for steel, and 3e-5 of the module; where the found rotation asks for more, that is taken.
    double first_reach(const GearPair &pair, const double torque)
    {
      const double stiffness = 0.123 * effective_modulus(pair) * pair.common_face_width;
      return 4 * torque / (pair.pinion.base_radius * std::cos(pair.base_helix_angle)) / stiffness +
             pair.data.transverse_module / 3e4;
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

  std::vector<FirstGrid> first_grids(const GearPair &pair, const MeshDeviations &deviations,
                                     const int per_face_width, const std::vector<double> &torques,
                                     const double phase)
  {
    const MeshPosition position(pair, deviations, phase);
    const std::vector<Slice> slices = position.slices_finer_at_corners(per_face_width).first;
    const auto apart = [&](const Slice &slice) { return slice.touch + position.stand_back(slice, 0); };
    double closest = HUGE_VAL;
    for (const Slice &slice : slices)
      closest = std::min(closest, apart(slice));
    std::vector<FirstGrid> grids;
    for (const double torque : torques)
      {
        const double reach = closest + first_reach(pair, 1.2 * sizing_torque(pair, torque));
        FirstGrid &grid = grids.emplace_back();
        for (const Slice &slice : slices)
          if (apart(slice) <= reach)
            {
              const double half = 0.5 * (pair.common_face_width - slice.height);
              ++grid.slices;
              grid.to_ends = { std::min(grid.to_ends[0], half + slice.z),
                               std::min(grid.to_ends[1], half - slice.z) };
            }
      }
    return grids;
  }

  namespace
  {
    /// The search for the grids that fit, for one position, mesh cycle and octave.
    class FittedGrids
    {
    public:
      FittedGrids(const MeshBodies &bodies, const SlicedPosition &sliced, const std::vector<double> &torques,
                  const int cycle, PositionCompliance &compliance,
                  const std::function<void(const FittedGrid &)> &found)
          : bodies_(bodies)
          , position_(sliced.position)
          , torques_(torques)
          , cycle_(cycle)
          , compliance_(compliance)
          , found_(found)
          , size_(sizing_torque(bodies.pair, torques.front()))
      {
      }

      /// What the grids are sized for. [N mm]
      double size() const { return size_; }

      /// Torques whose grid has these slices. attempt: how many other slices they have had.
      void on_slices(const SlicesInReach &slices, const std::vector<std::size_t> &torques, const int attempt)
      {
        if (attempt == 24)
          throw ComputationError(
              fmt::format("tooth pairs outside the reach of {:.4g} mm still touch at phase {:.4f}",
                          slices.reach, phase()));
        for (const auto &[next, torque] : fit_on(slices, torques))
          on_slices(next, { torque }, attempt + 1);
      }

    private:
      /// Torques that ask for other slices, each with them.
      using SlicedAnew = std::vector<std::pair<SlicesInReach, std::size_t>>;

      SlicedAnew fit_on(const SlicesInReach &slices, const std::vector<std::size_t> &torques)
      {
        PositionGrid grid(bodies_, position_, compliance_, slices, cycle_, size_);
        // One cell a slice is good to some percent, and the size is within 1.7 times the torque: four times
        // the limit is beyond it, and no grid need be built.
        require_linear(torques_[torques.front()], grid.coarse_rotation(), 4);
        SlicedAnew sliced_anew;
        on_windows(grid, grid.windows(), slices.all, torques, sliced_anew);
        return sliced_anew;
      }

      /// Torques whose windows on these slices are these.
      void on_windows(PositionGrid &grid, const PositionGrid::Windows &windows, const std::vector<Slice> &all,
                      const std::vector<std::size_t> &torques, SlicedAnew &sliced_anew)
      {
        grid.build(windows);
        std::vector<double> values;
        for (const std::size_t t : torques)
          values.push_back(torques_[t]);
        const std::vector<ContactSolution> solutions =
            SimplexSolver(grid.problem()).sweep(values, grid.expected_contact());

        FittedGrid fitted{ .grid = grid, .torques = {}, .solutions = {}, .certificates = {} };
        std::vector<std::pair<PositionGrid::Windows, std::vector<std::size_t>>> refitted;
        for (std::size_t k = 0; k < torques.size(); ++k)
          {
            const ContactSolution &solution = solutions[k];
            if (std::optional<PositionGrid::Windows> next = grid.refitted(solution))
              {
                const auto same =
                    std::ranges::find(refitted, *next, [](const auto &group) { return group.first; });
                auto &group = same != refitted.end()
                                  ? *same
                                  : refitted.emplace_back(std::move(*next), std::vector<std::size_t>());
                group.second.push_back(torques[k]);
                continue;
              }
            const Certificate certificate = certify(grid.problem(), solution);
            require(solution, certificate);
            if (std::optional<SlicesInReach> next = grid.other_slices(solution))
              {
                sliced_anew.emplace_back(std::move(*next), torques[k]);
                continue;
              }
            require(solution, certify_grid(bodies_, position_, cycle_, all, grid.cells(), solution.force,
                                           solution.theta));
            fitted.torques.push_back(torques[k]);
            fitted.solutions.push_back(solution);
            fitted.certificates.push_back(certificate);
          }
        if (!fitted.torques.empty())
          found_(fitted);
        for (const auto &[next, of_group] : refitted)
          on_windows(grid, next, all, of_group, sliced_anew);
      }

      /// Throws where the teeth would leave each other. [N mm, rad]
      void require_linear(const double torque, const double rotation, const double modules = 1) const
      {
        const GearPair &pair = bodies_.pair;
        if (const double deflection = pair.pinion.base_radius * rotation;
            deflection > modules * pair.data.transverse_module)
          throw ComputationError(fmt::format(
              "a transmission error of {:.4g} mm at phase {:.4f}, torque {:.6g} N m exceeds the module "
              "({:.4g} mm): the teeth would leave each other, and "
              "linear elasticity holds no longer; lower the torque or check Young's modulus and face width",
              deflection, phase(), torque / units::newton_metre, pair.data.transverse_module));
      }

      /// Throws if a solution is not one, or not of linear elasticity.
      void require(const ContactSolution &solution, const Certificate &certificate) const
      {
        const double torque = solution.torque / units::newton_metre;
        if (solution.status != Status::solved)
          throw ComputationError(
              fmt::format("the contact solver found no solution at phase {:.4f}, torque {:.6g} N m ({})",
                          phase(), torque, counted(solution.pivots, "pivot")));
        if (!certificate.holds())
          throw ComputationError(fmt::format(
              "certificate failed at phase {:.4f}, torque {:.6g} N m: penetration {:.3g}, adhesion {:.3g}, "
              "complementarity {:.3g}, balance {:.3g}, allowed {:.3g}",
              phase(), torque, certificate.penetration, certificate.adhesion, certificate.complementarity,
              certificate.balance, certificate.gate));
        require_linear(solution.torque, solution.theta);
      }

      /// Throws if the cells under a solution do not cover or resolve the contact.
      void require(const ContactSolution &solution, const GridCertificate &certificate) const
      {
        if (!certificate.holds())
          throw ComputationError(
              fmt::format("the contact grid failed its certificate at phase {:.4f}, torque {:.6g} N m: {}",
                          phase(), solution.torque / units::newton_metre, certificate.describe()));
      }

      double phase() const { return position_.phase() + cycle_; }

      const MeshBodies &bodies_;
      const MeshPosition &position_;
      const std::vector<double> &torques_;
      int cycle_;
      PositionCompliance &compliance_;
      const std::function<void(const FittedGrid &)> &found_;
      double size_; ///< [N mm]
    };
  } // namespace

  void solve_on_fitted_grids(const MeshBodies &bodies, const SlicedPosition &sliced,
                             const std::vector<double> &torques, const int cycle,
                             PositionCompliance &compliance,
                             const std::function<void(const FittedGrid &)> &found)
  {
    std::vector<std::size_t> all(torques.size());
    std::iota(all.begin(), all.end(), 0);
    FittedGrids grids(bodies, sliced, torques, cycle, compliance, found);
    grids.on_slices(sliced.in_reach(first_reach(bodies.pair, 1.2 * grids.size())), all, 0);
  }
} // namespace flank
