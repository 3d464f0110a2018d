// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/pressure_maps.hpp"

#include "cases/double_roller/results.hpp"
#include "cases/results/field_view.hpp"
#include "cases/results/hdf5_file.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"
#include "solver/libraries/vtu_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  std::vector<Key> PressureMaps::keys()
  {
    return { keys::numbers("output.pressure_maps_deg", -3600, 36000, "none",
                           "crank angles whose pressure maps are kept in results.h5 [deg]"),
             keys::text("output.pressure_fields", "no",
                        "yes: these pressure maps also on rollers and sleeves for ParaView",
                        { "no", "yes" }) };
  }

  PressureMaps::PressureMaps(const CaseFile &file, const std::vector<double> &crank_angles)
  {
    if (file.has("output.pressure_maps_deg"))
      for (const double angle : file.numbers("output.pressure_maps_deg"))
        {
          const auto at = std::ranges::find_if(crank_angles, [&](const double computed) {
            return std::abs(computed - angle * units::degree) < 1e-9;
          });
          const auto position = static_cast<std::size_t>(at - crank_angles.begin());
          if (std::ranges::find(positions_, position) != positions_.end())
            throw InputError(file.place("output.pressure_maps_deg") +
                             fmt::format("{:.9g} deg is given twice; give every angle once", angle));
          if (at == crank_angles.end())
            throw InputError(file.place("output.pressure_maps_deg") +
                             fmt::format("{:.9g} deg is none of the crank angles that are computed "
                                         "(mesh_cycle.crank_angles_deg)",
                                         angle));
          positions_.push_back(position);
        }
    std::ranges::sort(positions_);
    fields_ = file.text("output.pressure_fields") == "yes";
    if (fields_ && positions_.empty())
      throw InputError(file.place("output.pressure_fields") +
                       "needs output.pressure_maps_deg: the crank angles to show");
  }

  std::string PressureMaps::left_out() const
  {
    return std::string("pressure maps but those of output.pressure_maps_deg") +
           (fields_ ? "" : "; files for ParaView, output.pressure_fields is no");
  }

  void PressureMaps::write(Hdf5File &out, const LoadedDrive &drive, const DoubleRollerResults &results) const
  {
    for (std::size_t t = 0; t < results.at.size(); ++t)
      for (const std::size_t k : positions_)
        for (const RollerPairLoad &load : results.at[t][k].pairs)
          {
            const PressureMap map = drive.laws().map(load.sleeve_radius, load.force);
            const std::string group = fmt::format("pressure_maps/torque_{}_position_{}/roller_{}_sleeve_{}",
                                                  t, k, load.roller, load.sleeve);
            const auto column = [&](const char *name, const std::vector<double> &values, const char *unit) {
              out.dataset(group, name, { values.size() }, values, unit);
            };
            column("x", map.x, "mm");
            column("y", map.y, "mm");
            column("half_x", map.half_x, "mm");
            column("half_y", map.half_y, "mm");
            column("pressure", map.pressure, "MPa");
          }
  }

  namespace
  {
    /// Point of a cylinder's surface at an arc length from where it is touched; `inward` points from there to
    /// its axis.
    Eigen::Vector2d on_cylinder(const Eigen::Vector2d &touched, const Eigen::Vector2d &inward,
                                const double radius, const double arc)
    {
      const Eigen::Vector2d tangent(-inward.y(), inward.x());
      return touched + radius * ((1 - std::cos(arc / radius)) * inward + std::sin(arc / radius) * tangent);
    }
  } // namespace

  FieldPiece pressure_field(const LoadedDrive &drive, const DrivePosition &position)
  {
    const DoubleRollerDrive &kinematics = drive.drive();
    FieldPiece piece{ .dimension = 2,
                      .degree = 1,
                      .arrays = { { "pressure_MPa", 1 },
                                  { "area_mm2", 1 },
                                  { "pair_force_N", 1 },
                                  { "body_1_roller_2_sleeve", 1 },
                                  { "roller", 1 },
                                  { "sleeve", 1 } } };
    for (const RollerPairLoad &load : position.pairs)
      {
        const PressureMap map = drive.laws().map(load.sleeve_radius, load.force); // a quarter
        const Eigen::Vector2d axis = kinematics.roller_centre(load.roller),
                              towards = drive.towards_sleeve(load.roller, load.sleeve, position.crank_angle,
                                                             position.psi);
        const double radius = kinematics.roller_radius(load.roller);
        const Eigen::Vector2d touched = axis + radius * towards;
        for (const int body : { 1, 2 })
          for (std::size_t i = 0; i < map.x.size(); ++i)
            for (const int side_x : { -1, 1 })
              for (const int side_y : { -1, 1 })
                {
                  Eigen::MatrixXd values(9, 4);
                  for (int corner = 0; corner < 4; ++corner)
                    {
                      const double arc = side_x * map.x[i] + (corner % 2 ? 1 : -1) * map.half_x[i];
                      const Eigen::Vector2d at = body == 1
                                                     ? on_cylinder(touched, -towards, radius, -arc)
                                                     : on_cylinder(touched, towards, load.sleeve_radius, arc);
                      values.col(corner) << at, side_y * map.y[i] + (corner / 2 ? 1 : -1) * map.half_y[i],
                          map.pressure[i], 4 * map.half_x[i] * map.half_y[i], load.force, body, load.roller,
                          load.sleeve;
                    }
                  piece.cells.push_back(std::move(values));
                }
      }
    return piece;
  }

  FieldPiece drive_shape(const DoubleRollerCase &input, const LoadedDrive &drive,
                         const DrivePosition &position)
  {
    const DoubleRollerDrive &kinematics = drive.drive();
    FieldPiece piece{ .dimension = 2,
                      .degree = 1,
                      .arrays = { { "body_1_roller_2_sleeve", 1 }, { "number", 1 }, { "force_N", 1 } } };
    const auto cylinder = [&](const Eigen::Vector2d &centre, const double radius, const int body,
                              const int number) {
      double force = 0;
      for (const RollerPairLoad &load : position.pairs)
        if ((body == 1 ? load.roller : load.sleeve) == number)
          force += load.force;
      constexpr int facets = 48;
      for (int f = 0; f < facets; ++f)
        {
          Eigen::MatrixXd values(6, 4);
          for (int corner = 0; corner < 4; ++corner)
            {
              const double angle = 2 * units::pi * (f + corner % 2) / facets;
              values.col(corner) << centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                  (corner / 2 ? 0.5 : -0.5) * input.contact.width, body, number, force;
            }
          piece.cells.push_back(std::move(values));
        }
    };
    for (int k = 1; k <= input.drive.rollers; ++k)
      cylinder(kinematics.roller_centre(k), kinematics.roller_radius(k), 1, k);
    const DoubleRollerDrive::Pose pose = kinematics.pose(position.crank_angle, position.psi);
    for (int n = 1; n <= kinematics.sleeves() && !input.model.conjugate; ++n)
      cylinder(kinematics.sleeve_centre_at(n, pose), kinematics.sleeve_radius(n), 2, n);
    return piece;
  }

  void PressureMaps::write_fields(const ResultFolder &folder, const DoubleRollerCase &input,
                                  const LoadedDrive &drive, const DoubleRollerResults &results) const
  {
    if (!fields_)
      return;
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const std::string torque = fmt::format("{:.9g}Nm", input.torques[t] / units::newton_metre);
        std::vector<std::pair<double, std::string>> pressures, shapes;
        for (const std::size_t k : positions_)
          {
            const DrivePosition &position = results.at[t][k];
            const auto write = [&](const char *what, const FieldPiece &piece, auto &series) {
              const std::string name = fmt::format("{}_{}_position_{:04d}.vtu", what, torque, k);
              folder.write("fields/" + name, [&](const std::string &path) { write_vtu(path, piece); });
              series.emplace_back(position.crank_angle / units::degree, name);
            };
            if (!position.pairs.empty())
              write("pressure", pressure_field(drive, position), pressures);
            write("drive", drive_shape(input, drive, position), shapes);
          }
        for (const auto &[what, series] : { std::pair{ "pressure", &pressures }, { "drive", &shapes } })
          if (!series->empty())
            folder.write(fmt::format("fields/{}_{}.pvd", what, torque),
                         [list = series](const std::string &path) { write_pvd(path, *list); });
      }
    folder.write("fields/view.py", field_view);
  }
} // namespace flank
