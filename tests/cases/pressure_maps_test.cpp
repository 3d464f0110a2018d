// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/pressure_maps.hpp"
#include "cases/double_roller/results.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/drive_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace flank;
using units::degree;

TEST(PressureFields, LieOnTheSurfacesAndCarryTheForces)
{
  for (const char *profile : { "circular", "conjugate" })
    {
      const DoubleRollerCase input = drive_case("exact", { std::string("drive.profile=") + profile });
      const LoadedDrive drive(input);
      const DrivePosition position = drive.solve(7 * degree, 20e3);
      const FieldPiece field = pressure_field(drive, position);
      ASSERT_GE(position.pairs.size(), input.model.conjugate ? 3u : 1u);
      for (const RollerPairLoad &load : position.pairs)
        {
          double carried[2] = { 0, 0 };
          const Eigen::Vector2d roller = drive.drive().roller_centre(load.roller),
                                sleeve = drive.drive().sleeve_centre_at(
                                    load.sleeve, drive.drive().pose(position.crank_angle, position.psi));
          for (const Eigen::MatrixXd &cell : field.cells)
            if (cell(7, 0) == load.roller && cell(8, 0) == load.sleeve)
              {
                const bool on_roller = cell(6, 0) == 1;
                carried[on_roller ? 0 : 1] += cell(3, 0) * cell(4, 0);
                for (Eigen::Index corner = 0; corner < 4; ++corner)
                  {
                    const Eigen::Vector2d at = cell.col(corner).head<2>();
                    if (on_roller || !input.model.conjugate) // a conjugate sleeve is no cylinder
                      {
                        EXPECT_NEAR((at - (on_roller ? roller : sleeve)).norm(),
                                    on_roller ? drive.drive().roller_radius(load.roller)
                                              : drive.drive().sleeve_radius(load.sleeve),
                                    on_roller ? 1e-9 : load.approach + 1e-9);
                      }
                    EXPECT_LE(std::abs(cell(2, corner)), input.contact.width / 2 + 1e-9);
                  }
              }
          for (const double force : carried)
            EXPECT_NEAR(force, load.force,
                        1e-3 * load.force); // the law between its nodes against a solution of its own
        }
    }
}

// Rollers and sleeves have numbers of their own: each body carries the forces of the pairs that name it.
TEST(PressureFields, EveryBodyOfTheDriveHasItsOwnForce)
{
  const DoubleRollerCase input = drive_case("exact");
  const LoadedDrive drive(input);
  const DrivePosition position = drive.solve(427 * degree, 20e3);
  std::map<std::pair<int, int>, double> expected;
  bool other_number = false;
  for (const RollerPairLoad &load : position.pairs)
    {
      expected[{ 1, load.roller }] += load.force;
      expected[{ 2, load.sleeve }] += load.force;
      other_number = other_number || load.roller != load.sleeve;
    }
  ASSERT_TRUE(other_number);
  const FieldPiece shape = drive_shape(input, drive, position);
  ASSERT_FALSE(shape.cells.empty());
  for (const Eigen::MatrixXd &cell : shape.cells)
    {
      const std::pair body(static_cast<int>(cell(3, 0)), static_cast<int>(cell(4, 0)));
      EXPECT_EQ(cell(5, 0), expected[body]) << body.first << ", " << body.second;
    }
}
