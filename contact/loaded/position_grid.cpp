// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/position_grid.hpp"

#include "contact/half_space/hertz.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <Eigen/Cholesky>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    // What places cells besides the bodies. A field that is added to one of the structures and not here does
    // not compile.

    /// The fields of a gear's data that place cells. Left out are those that shape and stiffen the body,
    /// which the identity of its operator has; tip radius and chamfer, which are in usable_tip_roll; the
    /// name.
    std::vector<double> placing_cells(const GearData &gear)
    {
      const auto &[name, teeth, face_width, tip_radius, root_radius, tooth_thickness, profile_shift,
                   bore_radius, fillet_radius, youngs_modulus, poissons_ratio, tip_chamfer, tip_rounding] =
          gear;
      return { tip_rounding };
    }

    /// The fields of a gear's geometry that place cells. Left out are the involute and its helix, which the
    /// identity of the body has, and what follows from other fields.
    std::vector<double> placing_cells(const GearGeometry &geometry)
    {
      const auto &[reference_radius, base_radius, base_helix_angle, helix_angle, half_angle_at_base, tip_roll,
                   usable_tip_roll, form_radius, form_roll, tip_thickness] = geometry;
      return { usable_tip_roll, form_roll };
    }

    /// The fields of a pair's data that place cells. Left out are module and angles, which the identities of
    /// the bodies have, and both gears, which are looked at with their geometry. Hand and drive are in the
    /// sign of z.
    std::vector<double> placing_cells(const PairData &data)
    {
      const auto &[centre_distance, transverse_module, transverse_pressure_angle, helix_angle, pinion_hand,
                   counter_clockwise_drive, pinion, gear, axial_offset] = data;
      return { centre_distance, axial_offset, canonical_z_sign(data) };
    }
  } // namespace

  /// Fields of GearPair that follow from the centre distance and the bodies are left out, and so are its
  /// warnings.
  std::string identity_of_cells(const GearPair &pair, const ContactGridSize &grid)
  {
    const auto &[data, pinion, gear, normal_module, normal_pressure_angle, working_pressure_angle,
                 base_helix_angle, line_of_action, length_of_action, transverse_base_pitch,
                 transverse_contact_ratio, overlap_ratio, common_face_width, face_low, face_high, backlash,
                 pinion_tip_clearance, gear_tip_clearance, pinion_roll, gear_roll, warnings] = pair;
    const auto &[slices, profile_cells] = grid;
    const std::vector<std::vector<double>> values = { placing_cells(data),
                                                      { face_low, face_high },
                                                      placing_cells(static_cast<const GearData &>(pinion)),
                                                      placing_cells(
                                                          static_cast<const GearGeometry &>(pinion)),
                                                      placing_cells(static_cast<const GearData &>(gear)),
                                                      placing_cells(static_cast<const GearGeometry &>(gear)),
                                                      { 1.0 * slices, 1.0 * profile_cells } };
    std::string all;
    for (const std::vector<double> &group : values)
      for (const double value : group)
        all += fmt::format("{:.17g} ", value);
    return all;
  }

  double effective_modulus(const GearPair &pair)
  {
    return half_space::effective_modulus(pair.pinion.youngs_modulus, pair.pinion.poissons_ratio,
                                         pair.gear.youngs_modulus, pair.gear.poissons_ratio);
  }

  PositionGrid::PositionGrid(const MeshBodies &bodies, const MeshPosition &position,
                             PositionCompliance &compliance, const SlicesInReach &slices, const int cycle,
                             const double torque)
      : bodies_(bodies)
      , position_(position)
      , cycle_(cycle)
      , all_(slices)
      , torque_(torque)
      , modulus_(effective_modulus(bodies.pair))
      , compliance_(compliance)
  {
    const double limit = in_reach();
    for (const Slice &slice : all_.all)
      (touch(slice) <= limit ? slices_ : left_out_).push_back(slice);
    size_windows();
  }

  /// A window of this half-width about any place of a flank holds all of it. [mm]
  double PositionGrid::whole_flank() const
  {
    double widest = 0;
    for (const Gear *gear : { &bodies_.pair.pinion, &bodies_.pair.gear })
      widest = std::max(widest, profile_length(gear->form_roll, gear->tip_roll, gear->base_radius));
    return 1.2 * widest; // add_cells() rounds down by less
  }

  double PositionGrid::in_reach() const
  {
    double least = 1e300;
    for (const Slice &slice : all_.all)
      least = std::min(least, touch(slice));
    return least + all_.reach;
  }

  double PositionGrid::touch(const Slice &slice) const
  {
    return slice.touch + position_.stand_back(slice, cycle_);
  }

  /// Compliance between the cells: the bodies, and what each spring of the mounting adds. A tilt or twist q
  /// about an axis with the levers L turns until K q = L.f, so that it moves the flanks by L q: C + L L'/K,
  /// exactly what it would do as a further rigid unknown.
  void PositionGrid::assemble()
  {
    const auto n = static_cast<Eigen::Index>(cells_.size());
    if (n == 0)
      throw ComputationError(fmt::format(
          "no part of the flanks faces another one at phase {:.4f}: there is nothing to carry the torque; "
          "check centre distance, tip diameters and face widths (flank check)",
          position_.phase() + cycle_));
    problem_.gap.resize(n);
    problem_.lever.resize(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        problem_.gap[i] = cells_[i].gap + position_.stand_back(slices_[cells_[i].slice], cycle_);
        problem_.lever[i] = cells_[i].lever;
      }
    asymmetry_ = compliance_.assemble(cells_, windows_, problem_.compliance);

    if (const Levers soft = flexibility(); !soft.isZero(0))
      {
        Eigen::Matrix<double, Eigen::Dynamic, 6> lever(n, 6);
        for (Eigen::Index i = 0; i < n; ++i)
          lever.row(i) = levers(slices_[cells_[i].slice], cells_[i].tilt);
        problem_.compliance += lever * soft.asDiagonal() * lever.transpose();
      }
    if (!problem_.gap.allFinite() || !problem_.lever.allFinite() || !problem_.compliance.allFinite() ||
        !(problem_.compliance.diagonal().minCoeff() > 0))
      throw ComputationError(fmt::format(
          "the cells at phase {:.4f}, torque {:.6g} N m have no compliance of an elastic body; a segment "
          "needs "
          "more teeth or clamped cut faces (body.segment_teeth, body.cut_faces), a body a mesh that its "
          "proportions allow (mesh keys)",
          position_.phase() + cycle_, torque_ / units::newton_metre));
  }

  PositionGrid::Levers PositionGrid::levers(const Slice &slice, const Eigen::Vector4d &tilt)
  {
    Levers result;
    result << slice.lever, slice.gear_lever, tilt;
    return result;
  }

  PositionGrid::Levers PositionGrid::flexibility() const
  {
    const Mounting &p = bodies_.pinion_mounting, &g = bodies_.gear_mounting;
    Levers stiffness;
    stiffness << p.torsion, g.torsion, p.tilt_in_plane, p.tilt_across, g.tilt_in_plane, g.tilt_across;
    return stiffness.cwiseInverse();
  }

  PositionGrid::Levers PositionGrid::moments(const Eigen::VectorXd &force) const
  {
    Levers sum = Levers::Zero();
    for (std::size_t i = 0; i < cells_.size(); ++i)
      sum += force[i] * levers(slices_[cells_[i].slice], cells_[i].tilt);
    return sum;
  }

  Eigen::Vector4d PositionGrid::tilt(const Eigen::VectorXd &force) const
  {
    // The pinion is pushed against its normal, the gear along it.
    return moments(force).cwiseProduct(flexibility()).tail<4>().cwiseProduct(Eigen::Vector4d(-1, -1, 1, 1));
  }

  void PositionGrid::build(const Windows &windows)
  {
    fit_ = windows;
    add_cells(fit_, bodies_.grid.profile_cells);
    assemble();
  }

  /// Half-widths are rounded to steps of the root of 2 and centres to 3e-8 of the module, so that grids of a
  /// position share slices. A larger pair has the same grid, larger.
  void PositionGrid::add_cells(const Windows &windows, const int across)
  {
    const double unit = bodies_.pair.data.transverse_module / 3e3, centre_unit = 1e-4 * unit; // [mm]
    cells_.clear();
    windows_.clear();
    for (std::size_t s = 0; s < slices_.size(); ++s)
      {
        const int step = static_cast<int>(std::lround(2 * std::log2(windows.half_width[s] / unit)));
        const int centre = static_cast<int>(std::lround(windows.centre[s] / centre_unit));
        windows_.push_back({ slices_[s].number, centre, step, across });
        position_.add_cells(slices_[s], static_cast<int>(s), centre * centre_unit,
                            unit * std::exp2(step / 2.0), across, cells_);
      }
  }

  std::vector<int> PositionGrid::expected_contact() const
  {
    std::vector<std::pair<double, int>> expected;
    const double rb = bodies_.pair.pinion.base_radius;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      {
        const Slice &slice = slices_[cells_[i].slice];
        const double roll = cells_[i].pinion.roll, along = profile_length(slice.pinion_roll, roll, rb);
        // The square of the expected pressure is as this, but for the materials and the radius; less is sure
        // at a tip edge.
        const double distance = std::abs(along - slice.touch_offset), half_width = hertz_[cells_[i].slice],
                     sure = (half_width - distance) * (half_width + distance);
        const bool at_edge = cells_[i].cut_short;
        if (sure > 0)
          expected.emplace_back(at_edge ? sure / 4 : sure, static_cast<int>(i));
      }
    std::sort(expected.begin(), expected.end(), std::greater());
    std::vector<int> cells;
    for (const auto &[sure, cell] : expected)
      cells.push_back(cell);
    return cells;
  }

  double PositionGrid::mean_line_load() const
  {
    const GearPair &pair = bodies_.pair;
    double covered = 0; // by the slices, along the axis [mm]
    for (const Slice &slice : slices_)
      covered += slice.height;
    return torque_ /
           (pair.pinion.base_radius * std::min(covered, pair.total_contact_ratio() * pair.common_face_width));
  }

  ContactSolution PositionGrid::loads_of_slices(const double mean_load)
  {
    fit_.centre.assign(slices_.size(), 0.0);
    for (const Slice &slice : slices_)
      fit_.half_width.push_back(
          std::min(whole_flank(),
                   units::pi / 4 *
                       half_space::hertz_half_width(position_.relative_radius(slice), modulus_, mean_load)));
    add_cells(fit_, 1);
    assemble();
    for (std::size_t i = 0; i < cells_.size(); ++i)
      problem_.gap[i] = touch(slices_[cells_[i].slice]);
    const ContactSolution coarse = SimplexSolver(problem_).solve(torque_);
    if (coarse.status != Status::solved)
      {
        const bool elastic = Eigen::LLT<Eigen::MatrixXd>(problem_.compliance).info() == Eigen::Success;
        throw ComputationError(fmt::format(
            "the contact solver found no solution at phase {:.4f}, torque {:.6g} N m: {}",
            position_.phase() + cycle_, torque_ / units::newton_metre,
            elastic ? "one cell a slice does not carry it"
                    : "loads move other teeth more than their own, as no elastic body does; a segment needs "
                      "more teeth or clamped cut faces (body.segment_teeth, body.cut_faces)"));
      }
    return coarse;
  }

  /// One cell a slice first: which slice carries what, so that every window can follow its own load.
  void PositionGrid::size_windows()
  {
    const double cos_bb = std::cos(bodies_.pair.base_helix_angle);
    const double mean_load = mean_line_load();
    const ContactSolution coarse = loads_of_slices(mean_load);
    coarse_rotation_ = coarse.theta;
    std::vector<double> load(slices_.size(), 0.0);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      load[cells_[i].slice] += coarse.force[i] * cos_bb / slices_[cells_[i].slice].height;
    fit_.half_width.resize(slices_.size());
    hertz_.resize(slices_.size());
    for (std::size_t s = 0; s < slices_.size(); ++s)
      {
        // The greatest of the slice and its neighbours on the same tooth pair; never less than 0.4 of the
        // mean load.
        double line = 0.4 * mean_load;
        for (std::size_t t = s > 0 ? s - 1 : 0; t <= s + 1 && t < slices_.size(); ++t)
          if (slices_[t].pair == slices_[s].pair)
            line = std::max(line, load[t]);
        // Room around the contact where it is, which deviations move away from the closest point of the
        // unmodified surfaces.
        const double radius = position_.relative_radius(slices_[s]);
        const double hertz = half_space::hertz_half_width(radius, modulus_, line);
        hertz_[s] = load[s] > 0 ? half_space::hertz_half_width(radius, modulus_, load[s]) : 0;
        const double offset = slices_[s].touch_offset;
        const bool is_beside = std::abs(offset) > 3 * hertz; // a window of both would not resolve it
        fit_.centre[s] = is_beside ? offset : 0;
        fit_.half_width[s] =
            window_over_contact * hertz + std::max(0.05 * hertz, is_beside ? 0 : std::abs(offset));
        if (position_.distance_to_edge(slices_[s]) <
            hertz) // an edge cuts the contact short on one side: it grows on the other
          fit_.half_width[s] *= 1.25;
        fit_.half_width[s] = std::min(fit_.half_width[s], whole_flank());
      }
  }
} // namespace flank
