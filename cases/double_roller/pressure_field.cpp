// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/pressure_field.hpp"

#include "cases/results/field_view.hpp"
#include "mesh/base/units.hpp"
#include "solver/libraries/vtu_file.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flank
{
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

  void write_pressure_fields(const ResultFolder &folder, const DoubleRollerCase &input,
                             const LoadedDrive &drive, const DoubleRollerResults &results)
  {
    for (std::size_t t = 0; t < input.torques.size(); ++t)
      {
        const std::string torque = fmt::format("{:.9g}Nm", input.torques[t] / units::newton_metre);
        std::vector<std::pair<double, std::string>> pressures, shapes;
        for (const std::size_t k : map_positions(input))
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
