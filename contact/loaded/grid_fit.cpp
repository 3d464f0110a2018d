// SPDX-License-Identifier: GPL-2.0-or-later
// How a position's grid is fitted to the contact that is found on it: the windows of its slices, and which
// slices there are.
#include "contact/loaded/grid_certificate.hpp"
#include "contact/loaded/position_grid.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace flank
{
  namespace
  {
    /// The loaded cells of a slice.
    struct LoadedSlice
    {
      double load = 0, moment = 0;       ///< along the profile, from the slice's closest point [N], [N mm]
      double low = 1e300, high = -1e300; ///< borders of the cells along the profile [mm]
      double pressure = 0, finite_pressure = 0; ///< greatest; where it has a limit [MPa]
      int cells = 0;
      bool inside = true; ///< else a tip edge cuts the contact short
    };

    std::vector<LoadedSlice> loaded_slices(const std::vector<Slice> &slices,
                                           const std::vector<ContactCell> &cells,
                                           const ContactSolution &solution, const double base_radius)
    {
      std::vector<LoadedSlice> of(slices.size());
      for (const int i : solution.active)
        if (const double force = solution.force[i]; force > 0)
          {
            const ContactCell &cell = cells[i];
            LoadedSlice &s = of[cell.slice];
            const double along =
                             profile_length(slices[cell.slice].pinion_roll, cell.pinion.roll, base_radius),
                         pressure = force / cell.area;
            s.load += force;
            s.moment += force * along;
            s.low = std::min(s.low, along - cell.pinion.half_profile);
            s.high = std::max(s.high, along + cell.pinion.half_profile);
            s.pressure = std::max(s.pressure, pressure);
            s.finite_pressure = std::max(s.finite_pressure, is_sharp(cell.place) ? 0 : pressure);
            s.inside = s.inside && !cell.cut_short;
            ++s.cells;
          }
      return of;
    }
  } // namespace

  std::optional<PositionGrid::Windows> PositionGrid::refitted(const ContactSolution &solution) const
  {
    constexpr int most_grids = 64, most_narrowed = 3,
                  most_resolved = 8; // windows that only widen reach the flank's edges after some 25
    if (solution.status != Status::solved || fit_.grids == most_grids)
      return std::nullopt;
    Windows next = fit_;
    ++next.grids;
    if (widen(next, solution) || (fit_.grids <= most_narrowed && narrow(next, solution)) ||
        (fit_.resolved < most_resolved && resolve(next, solution)))
      return next;
    return std::nullopt;
  }

  bool PositionGrid::widen(Windows &windows, const ContactSolution &solution) const
  {
    std::set<int> ending; // slices whose windows end in a loaded cell
    for (const int i : solution.active)
      if (cells_[i].window_border && solution.force[i] > 0)
        ending.insert(cells_[i].slice);
    for (const int s : ending)
      windows.half_width[s] = std::min(std::sqrt(2.0) * windows.half_width[s], whole_flank());
    return !ending.empty();
  }

  double PositionGrid::least_half_width(const std::size_t slice, const double centre) const
  {
    return std::exp2(0.25) * std::abs(slices_[slice].touch_offset - centre);
  }

  bool PositionGrid::narrow(Windows &windows, const ContactSolution &solution) const
  {
    std::vector<double> load(slices_.size(), 0.0);
    std::vector<int> loaded(slices_.size(), 0);
    for (const int i : solution.active)
      if (!slices_[cells_[i].slice].tip_edge && solution.force[i] > 0)
        {
          load[cells_[i].slice] += solution.force[i];
          ++loaded[cells_[i].slice];
        }
    const auto most = std::max_element(load.begin(), load.end()) - load.begin();
    const int cells = bodies_.grid.profile_cells;
    // Of a few cells, those that end a narrower window would be loaded, and it be widened again.
    const bool would_fit = std::sqrt(2.0) * loaded[most] + 1 <= cells - 2,
               is_too_wide = load[most] > 0 && 11 * loaded[most] < 5 * cells && would_fit;
    bool is_narrowed = false;
    for (std::size_t s = 0; is_too_wide && s < slices_.size(); ++s)
      {
        double &width = windows.half_width[s];
        const double least = least_half_width(s, windows.centre[s]),
                     narrowed = std::min(width, std::max(width / std::sqrt(2.0), least));
        is_narrowed = is_narrowed || narrowed < width;
        width = narrowed;
      }
    return is_narrowed;
  }

  std::vector<PositionGrid::OwnWindow> PositionGrid::unresolved(const ContactSolution &solution) const
  {
    const std::vector<LoadedSlice> of =
        loaded_slices(slices_, cells_, solution, bodies_.pair.pinion.base_radius);
    std::vector<OwnWindow> windows;
    double all = 0, unresolved = 0;
    for (std::size_t s = 0; s < of.size(); ++s)
      {
        all += of[s].load;
        if (of[s].inside && of[s].cells > 0 && of[s].cells < GridCertificate::fewest)
          {
            unresolved += of[s].load;
            windows.push_back({ s, of[s].moment / of[s].load, of[s].high - of[s].low });
          }
      }
    if (unresolved <= GridCertificate::most_unresolved * all)
      windows.clear();
    return windows;
  }

  bool PositionGrid::resolve(Windows &windows, const ContactSolution &solution) const
  {
    const std::vector<OwnWindow> own = unresolved(solution);
    for (const OwnWindow &window : own)
      {
        windows.centre[window.slice] = window.centre;
        windows.half_width[window.slice] = window.half_width;
      }
    if (!own.empty())
      ++windows.resolved;
    return !own.empty();
  }

  double PositionGrid::greatest_overlap(const std::vector<Slice> &slices,
                                        const ContactSolution &solution) const
  {
    double overlap = 0;
    const Levers yielded = moments(solution.force).cwiseProduct(flexibility());
    for (const Slice &slice : slices)
      overlap = std::max(overlap, solution.theta * slice.lever - levers(slice, slice.tilt).dot(yielded) -
                                      touch(slice));
    return overlap;
  }

  double PositionGrid::overlap_left_out(const ContactSolution &solution) const
  {
    return greatest_overlap(left_out_, solution);
  }

  std::optional<SlicesInReach> PositionGrid::other_slices(const ContactSolution &solution) const
  {
    if (overlap_left_out(solution) > 0)
      return further(solution);
    const std::optional<SlicesInReach> along = finer(solution);
    return along ? along : finer_at_ends(solution);
  }

  double PositionGrid::finest_slice() const
  {
    constexpr double of_slice = 1.5 / 65536;
    return of_slice * bodies_.pair.common_face_width / bodies_.grid.slices;
  }

  int PositionGrid::enough_slices(const int pair) const
  {
    double on_path = 0, all = 0; // of action, and beyond it too, along the axis [mm]
    for (const Slice &slice : all_.all)
      if (slice.pair == pair)
        {
          on_path += slice.tip_edge ? 0 : slice.height;
          all += slice.height;
        }
    // A pair that meets at a tip edge alone can carry anywhere along it.
    const double across =
        (on_path > 0 ? on_path : all) * bodies_.grid.slices / bodies_.pair.common_face_width;
    return static_cast<int>((std::lround(across) + 2) / 5);
  }

  std::optional<SlicesInReach> PositionGrid::finer(const ContactSolution &solution) const
  {
    struct OfPair
    {
      double load = 0;
      std::set<int> slices; ///< loaded ones
    };
    std::map<int, OfPair> pairs;
    for (const int i : solution.active)
      if (solution.force[i] > 0)
        {
          OfPair &pair = pairs[cells_[i].pinion.tooth];
          pair.load += solution.force[i];
          pair.slices.insert(cells_[i].slice);
        }
    const auto most = std::max_element(pairs.begin(), pairs.end(), [](const auto &a, const auto &b) {
      return a.second.load < b.second.load;
    });
    if (most == pairs.end())
      return std::nullopt;
    const int loaded = static_cast<int>(most->second.slices.size()), enough = enough_slices(most->first);
    double height = all_.height;
    if (loaded >= enough || height < finest_slice())
      return std::nullopt;
    // The contact may be a slice longer than the middles of loaded ones tell: never more than enough at once.
    for (height /= 2; 2 * (loaded + 1) * (all_.height / height) < enough; height /= 2)
      ;
    return divided(in_reach(), std::min(all_.reach, 1.5 * greatest_overlap(slices_, solution)), height);
  }

  std::map<int, double> PositionGrid::heights_at_ends(const ContactSolution &solution) const
  {
    // Shares of the contact's width: with 31 slices a quarter, at sharp ends a sixteenth.
    const double at_common_end = 8.0 / bodies_.grid.slices, at_sharp_end = 2.0 / bodies_.grid.slices;
    constexpr double shortest = 1.0 / 30;
    // Of the greatest pressure: a sharp end presses as much, but for rounding; towards a common one pressure
    // rises, however much less the end itself carries on a long slice. That of a level contact, or of a tooth
    // pair that carries less than another, does not.
    constexpr double as_much = 0.98, beside = 0.9, further_in = 0.95, rising = 1.002;
    const std::vector<LoadedSlice> of =
        loaded_slices(slices_, cells_, solution, bodies_.pair.pinion.base_radius);
    double greatest = 0;
    for (const LoadedSlice &slice : of)
      greatest = std::max(greatest, slice.finite_pressure);
    const auto pressure_inward = [&](const std::size_t s, const std::size_t slices) {
      const double middle =
          canonical_z_sign(bodies_.pair.data) * (bodies_.pair.face_low + bodies_.pair.face_high) / 2;
      const std::size_t t = slices_[s].z < middle ? s + slices : s - slices;
      return t < of.size() && slices_[t].pair == slices_[s].pair ? of[t].pressure : 0.0;
    };
    const auto is_governing = [&](const std::size_t s) {
      const double here = of[s].pressure, next = pressure_inward(s, 1);
      const bool is_sharp_end = slices_[s].end_power < 0;
      return (here >= as_much * greatest && (is_sharp_end || here > rising * next)) ||
             (here >= beside * greatest && pressure_inward(s, 3) < further_in * std::max(next, here));
    };
    std::map<int, double> heights;
    for (std::size_t s = 0; s < of.size(); ++s)
      if (slices_[s].face_end && of[s].inside && of[s].pressure > 0 && is_governing(s))
        {
          const double share = slices_[s].end_power < 0 ? at_sharp_end : at_common_end,
                       height =
                           std::max(std::max(share, shortest) * (of[s].high - of[s].low), finest_slice());
          if (slices_[s].height > height)
            heights[slices_[s].number] = height;
        }
    return heights;
  }

  std::optional<SlicesInReach> PositionGrid::finer_at_ends(const ContactSolution &solution) const
  {
    const std::map<int, double> heights = heights_at_ends(solution);
    if (heights.empty())
      return std::nullopt;
    SlicesInReach result = all_;
    result.all.clear();
    const std::function<void(const Slice &, double, double)> add =
        [&](const Slice &slice, const double height, const double end_power) {
          if (slice.face_end && slice.height > height)
            for (const Slice &half : position_.halves(slice, all_.undivided))
              add(half, height, end_power);
          else
            {
              result.all.push_back(slice);
              result.all.back().end_power = end_power; // all of the slice stays beside the end as it was
            }
        };
    for (const Slice &slice : all_.all)
      {
        const auto found = heights.find(slice.number);
        add(slice, found == heights.end() ? slice.height : found->second, slice.end_power);
      }
    return result;
  }

  SlicesInReach PositionGrid::further(const ContactSolution &solution) const
  {
    const double reach = std::max(1.6 * all_.reach, all_.reach + 1.1 * overlap_left_out(solution)),
                 limit = in_reach() - all_.reach + reach;
    SlicesInReach result = divided(limit, reach, all_.height);
    const auto taken = std::ranges::count_if(result.all, [&](const Slice &s) { return touch(s) <= limit; });
    const int most = 8 * bodies_.grid.slices + all_.undivided; // a contact is enough slices long, and margins
    if (taken > most)
      throw ComputationError(fmt::format(
          "{} slices touch within {:.3g} um at phase {:.4f}, torque {:.6g} N m, more than the {} that a "
          "contact as short as it seemed needs; a torque that differs more from the others, or another "
          "number of slices of the contact grid, may be solved",
          taken, 1e3 * reach, position_.phase() + cycle_, torque_ / units::newton_metre, most));
    return result;
  }

  SlicesInReach PositionGrid::divided(const double limit, const double reach, const double height) const
  {
    SlicesInReach result{ .all = {}, .undivided = all_.undivided, .height = height, .reach = reach };
    const std::function<void(const Slice &)> add = [&](const Slice &slice) {
      if (touch(slice) > limit || slice.height < 1.5 * height)
        result.all.push_back(slice);
      else
        std::ranges::for_each(position_.halves(slice, all_.undivided), add);
    };
    std::ranges::for_each(all_.all, add);
    return result;
  }
} // namespace flank
