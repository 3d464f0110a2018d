// SPDX-License-Identifier: GPL-2.0-or-later
// Contact grids: mesh cycles do not know each other, and what does not cover or resolve the contact is not
// certified.
#include "contact/half_space/hertz.hpp"
#include "contact/loaded/grid_certificate.hpp"
#include "contact/loaded/load_distribution.hpp"
#include "mesh/base/errors.hpp"
#include "tests/contact/deviations.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

using namespace flank;
using units::degree;

namespace
{
  /// The spur pair of the example with the early tip relief, whose second tooth pair hardly carries at 30 to
  /// 40 N m.
  MeshDeviations late_relief(const GearPair &pair)
  {
    MeshDeviations deviations;
    for (auto [flanks, gear] :
         { std::pair{ &deviations.pinion, &pair.pinion }, { &deviations.gear, &pair.gear } })
      flanks->modifications = { std::make_shared<ProfileRelief>("tip relief", 10e-3, 23.6 * degree,
                                                                gear->tip_roll, ReliefShape::linear,
                                                                gear->base_radius),
                                std::make_shared<LeadCrown>(4e-3, gear->face_width) };
    return deviations;
  }

  /// Those of the helical example.
  MeshDeviations example_flanks(const GearPair &pair)
  {
    MeshDeviations deviations;
    for (auto [flanks, gear] :
         { std::pair{ &deviations.pinion, &pair.pinion }, { &deviations.gear, &pair.gear } })
      flanks->modifications = { std::make_shared<ProfileRelief>("tip relief", 5e-3, 22.2 * degree,
                                                                gear->tip_roll, ReliefShape::linear,
                                                                gear->base_radius),
                                std::make_shared<LeadCrown>(2e-3, gear->face_width) };
    return deviations;
  }

  /// Deviations of single teeth that repeat like nothing else. [mm]
  std::vector<double> scattered(const int teeth, const double amplitude)
  {
    std::vector<double> values;
    for (int k = 0; k < teeth; ++k)
      values.push_back(amplitude * std::sin(12.9898 * k + 78.233 * k * k));
    return values;
  }

  std::vector<int> first_cycles(const int count)
  {
    std::vector<int> cycles(count);
    std::iota(cycles.begin(), cycles.end(), 0);
    return cycles;
  }

  /// A position of the spur pair, its cells on windows of one half-width [mm] over all slices, and a solution
  /// on them.
  struct PlainGrid
  {
    GearPair pair = make_gear_pair(paper_pair(0));
    MeshDeviations none;
    LoadedPair mesh = mesh_of(pair, none);
    MeshPosition position{ pair, none, 0.0 };
    std::vector<Slice> slices = position.slices(small_grid.slices);
    std::vector<ContactCell> cells;

    PlainGrid(const double half_width, const int across)
    {
      for (std::size_t s = 0; s < slices.size(); ++s)
        position.add_cells(slices[s], static_cast<int>(s), 0, half_width, across, cells);
    }
    /// Hertz's pressure of half-width `contact` [mm] on the slices of the path of action of pair 0.
    Eigen::VectorXd force(const double contact) const
    {
      Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.size()));
      for (std::size_t i = 0; i < cells.size(); ++i)
        {
          const Slice &slice = slices[cells[i].slice];
          const double along = pair.pinion.base_radius / 2 *
                               (std::pow(cells[i].pinion.roll, 2) - std::pow(slice.pinion_roll, 2));
          if (slice.pair == 0 && std::abs(along) < contact)
            result[static_cast<Eigen::Index>(i)] =
                cells[i].area * std::sqrt(1 - std::pow(along / contact, 2));
        }
      return result;
    }
    GridCertificate certify(const double contact, const double theta = 0) const
    {
      return certify_grid(mesh.bodies, position, 0, slices, cells, force(contact), theta);
    }
  };
} // namespace

TEST(Hunting, WithoutErrorsIsTheMeshCycleAtEveryTorque)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const LoadedPair mesh = mesh_of(pair, late_relief(pair));
  for (const double phase : { 0.0, 0.3125, 0.5, 0.8125 })
    for (const double torque : { 5e3, 20e3, 30e3, 35e3, 40e3, 45e3, 60e3, 100e3, 300e3 })
      {
        const PositionResult alone = mesh.solve(phase, { torque })[0];
        for (const auto &cycle : mesh.solve(phase, { torque }, first_cycles(50)))
          {
            EXPECT_EQ(cycle[0].theta, alone.theta) << torque;
            EXPECT_EQ(cycle[0].max_pressure, alone.max_pressure) << torque;
          }
      }
}

TEST(Hunting, ACycleDoesNotKnowHowManyOthersThereAre)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  MeshDeviations deviations = late_relief(pair);
  deviations.pinion.index_errors = scattered(50, 2e-3);
  deviations.gear.index_errors = scattered(50, 3e-3);
  deviations.gear.runout = 8e-3;
  const LoadedPair mesh = mesh_of(pair, deviations);
  const std::vector<double> torques{ 70e3, 50e3 };
  const auto all = mesh.solve(0.25, torques, first_cycles(24));
  for (const int cycle : { 0, 5, 23 })
    {
      const auto alone = mesh.solve(0.25, torques, { cycle })[0];
      for (std::size_t t = 0; t < torques.size(); ++t)
        {
          EXPECT_EQ(all[cycle][t].theta, alone[t].theta) << cycle;
          EXPECT_EQ(all[cycle][t].max_pressure, alone[t].max_pressure) << cycle;
          EXPECT_EQ(all[cycle][t].phase, alone[t].phase) << cycle;
        }
    }
}

// Cells, and forces and gaps on them, are kept of the first cycle alone: a hunting period has thousands.
TEST(Hunting, LaterCyclesKeepNoCells)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations deviations = late_relief(pair);
  for (const bool with_errors : { false, true })
    {
      if (with_errors)
        deviations.pinion.index_errors = scattered(50, 2e-3);
      LoadedPair mesh = mesh_of(pair, deviations);
      mesh.keep_cells = true;
      const auto cycles = mesh.solve(0.25, { 50e3 }, first_cycles(4));
      ASSERT_TRUE(cycles[0][0].contact_cells);
      const auto n = static_cast<Eigen::Index>(cycles[0][0].contact_cells->size());
      EXPECT_EQ(cycles[0][0].contact_force.size(), n);
      EXPECT_EQ(cycles[0][0].contact_gap.size(), n);
      for (std::size_t cycle = 1; cycle < cycles.size(); ++cycle)
        {
          const PositionResult &later = cycles[cycle][0];
          EXPECT_FALSE(later.contact_cells);
          EXPECT_EQ(later.contact_force.size() + later.contact_gap.size(), 0);
          EXPECT_TRUE(later.cell_forces.empty());
        }
    }
}

// A pinion all of whose teeth are set back alike is the same pinion, turned: whatever touches, tip edges
// beside the path of action among it.
TEST(Hunting, AllTeethOfThePinionSetBackAreARotation)
{
  constexpr double back = 40e-3;
  for (const double helix : { 0.0, 25.232 })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      MeshDeviations set_back;
      set_back.pinion.index_errors.assign(50, back);
      const LoadedPair mesh = mesh_of(pair, {}), turned = mesh_of(pair, set_back);
      const double angle = back / (pair.pinion.base_radius * std::cos(pair.base_helix_angle));
      double at_edges = 0;
      for (const double phase : { 0.0, 0.2, 0.4, 0.6, 0.8 })
        {
          EXPECT_NEAR(turned.unloaded(phase).theta - mesh.unloaded(phase).theta, angle, 1e-13);
          const PositionResult one = mesh.solve(phase, { 400e3 })[0],
                               other = turned.solve(phase, { 400e3 })[0];
          EXPECT_NEAR(other.theta - one.theta, angle, 1e-13) << helix << " " << phase;
          EXPECT_NEAR(other.max_pressure, one.max_pressure, 1e-8 * one.max_pressure);
          EXPECT_NEAR(other.edge_pressure, one.edge_pressure, 1e-8 * one.edge_pressure);
          ASSERT_EQ(other.pairs.size(), one.pairs.size());
          for (std::size_t p = 0; p < one.pairs.size(); ++p)
            EXPECT_NEAR(other.pairs[p].force, one.pairs[p].force, 1e-8 * one.pairs[p].force);
          at_edges = std::max(at_edges, one.edge_pressure);
        }
      EXPECT_GT(at_edges, 0); // they are among it
    }
}

TEST(Hunting, TransmissionErrorGrowsWithTorqueWhateverTheTeethDo)
{
  for (const double helix : { 0.0, 25.232 })
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      MeshDeviations deviations = late_relief(pair);
      deviations.pinion.index_errors = scattered(50, 2e-3);
      const LoadedPair mesh = mesh_of(pair, deviations);
      for (const double phase : { 0.1, 0.6 })
        for (int cycle = 0; cycle < 6; ++cycle)
          {
            double before = mesh.unloaded(phase, cycle).theta;
            for (const double torque : { 1e3, 5e3, 20e3, 35e3, 60e3, 150e3, 400e3 })
              {
                const double theta = mesh.solve(phase, { torque }, { cycle })[0][0].theta;
                EXPECT_GT(theta, before) << phase << " " << cycle << " " << torque;
                before = theta;
              }
          }
    }
}

TEST(GridCertificate, HoldsForCellsThatCoverAndResolve)
{
  const PlainGrid grid(0.2, 11);
  EXPECT_TRUE(grid.certify(0.12).holds()) << grid.certify(0.12).describe();
}

TEST(GridCertificate, SeesAContactThatRunsOutOfItsWindow)
{
  const PlainGrid grid(0.1, 11);
  EXPECT_GT(grid.certify(0.12).open, 0.1);
  EXPECT_FALSE(grid.certify(0.12).holds());
}

TEST(GridCertificate, SeesAContactThatTheCellsAreTooWideFor)
{
  const PlainGrid grid(2.0, 11); // cells of 0.36 mm
  EXPECT_NEAR(grid.certify(0.2).unresolved, 1, 1e-12);
  EXPECT_FALSE(grid.certify(0.2).holds());
  const PlainGrid even(2.0, 10); // of 0.4 mm, two beside the middle
  EXPECT_NEAR(even.certify(0.3).unresolved, 1, 1e-12);
  EXPECT_FALSE(even.certify(0.3).holds());
}

TEST(GridCertificate, SeesSlicesWithoutCells)
{
  PlainGrid grid(0.2, 11);
  // Approached by 5 um along the line of action; one slice in the middle loses its cells.
  const double theta = 5e-3 / grid.pair.pinion.base_radius;
  EXPECT_EQ(grid.certify(0.12, theta).uncovered, 0);
  const Slice &lost = *std::find_if(grid.slices.begin(), grid.slices.end(),
                                    [](const Slice &s) { return s.pair == 0 && s.z > 0; });
  std::erase_if(grid.cells, [&](const ContactCell &c) {
    return c.pinion.tooth == 0 && std::abs(c.pinion.z - lost.z) < lost.height / 2;
  });
  EXPECT_NEAR(grid.certify(0.12, theta).uncovered, 5e-3, 1e-9);
  EXPECT_FALSE(grid.certify(0.12, theta).holds());
}

// Cells that a tip edge cuts obliquely have their middles beside the window's, and still cover it.
TEST(GridCertificate, IsNotMisledByCellsThatEdgesCut)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const MeshDeviations none;
  const LoadedPair mesh = mesh_of(pair, none);
  int judged = 0;
  for (int k = 0; k < 16; ++k)
    {
      const MeshPosition position(pair, none, k / 16.0);
      const std::vector<Slice> slices = position.slices(21);
      for (const double half_width : { 0.02, 0.06 })
        {
          std::vector<ContactCell> cells;
          for (std::size_t s = 0; s < slices.size(); ++s)
            position.add_cells(slices[s], static_cast<int>(s), slices[s].touch_offset, half_width, 11, cells);
          std::vector<Slice> on_path;
          std::ranges::copy_if(slices, std::back_inserter(on_path),
                               [](const Slice &s) { return !s.tip_edge; });
          const auto n = static_cast<Eigen::Index>(cells.size());
          const double theta = 5e-3 / pair.pinion.base_radius;
          EXPECT_EQ(certify_grid(mesh.bodies, position, 0, on_path, cells, Eigen::VectorXd::Zero(n), theta)
                        .uncovered,
                    0)
              << k << " " << half_width;
          judged += static_cast<int>(on_path.size());
        }
    }
  EXPECT_GT(judged, 1000);
}

TEST(GridCertificate, SeesWindowsBesideThePlaceOfTouch)
{
  PlainGrid grid(0.2, 11);
  const double theta = 5e-3 / grid.pair.pinion.base_radius;
  const auto s = std::ranges::find_if(grid.slices, [](const Slice &s) { return s.pair == 0 && s.z > 0; }) -
                 grid.slices.begin();
  std::erase_if(grid.cells, [&](const ContactCell &c) { return c.slice == s; });
  grid.position.add_cells(grid.slices[s], static_cast<int>(s), 0.6, 0.2, 11, grid.cells);
  ASSERT_FALSE(grid.slices[s].tip_edge);
  EXPECT_NEAR(grid.certify(0.12, theta).uncovered, 5e-3, 1e-9);
  EXPECT_FALSE(grid.certify(0.12, theta).holds());
}

// Light loads on crowned flanks press on an ellipse far shorter than a slice across the face; slices are
// halved until they resolve it. Hertz's point contact in closed form is the limit; what the bodies add is
// linear in the load, the mesh's stiffness less the contact's.
TEST(LightLoad, PressureAndApproachAreThoseOfHertzsEllipse)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const double amount = 20e-3, face = 20;
  const LoadedPair mesh = mesh_of(pair, on_pinion(std::make_shared<LeadCrown>(amount, face)), {}, {}, 41);
  const MeshPosition position(pair, mesh.deviations, 0);
  const double across = 1 / position.relative_radius(*position.slice_at(0, 0)),
               along = 8 * amount / (face * face);
  for (const double torque : { 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0 })
    {
      const double force = 1e3 * torque / pair.pinion.base_radius;
      const auto hertz = half_space::hertz_ellipse(along, across, effective_modulus(pair), force);
      const PositionResult result = mesh.solve(0, { 1e3 * torque })[0];
      // Eight slices or more on an ellipse and five cells across: the mean of the middle cell.
      EXPECT_NEAR(result.max_pressure, hertz.max_pressure, 0.02 * hertz.max_pressure) << torque;
      const double bodies = force / (12e3 * face); // N/(mm um) of the mesh, without the contact
      EXPECT_NEAR(transmission_error(pair, result), hertz.approach, 0.02 * hertz.approach + bodies) << torque;
      EXPECT_NEAR(result.max_pressure_z, 0, 0.2 * hertz.long_half_axis) << torque;
      double loaded = 0, carried = 0;
      for (const LineLoad &line : result.lines)
        loaded += line.height, carried += line.height * line.load_per_length;
      EXPECT_NEAR(loaded, 2 * hertz.long_half_axis, 0.4 * hertz.long_half_axis) << torque;
      EXPECT_NEAR(carried, force, 1e-9 * force) << torque;
    }
}

// The helical example half a pitch on: two pairs that are alike touch within their linear reliefs, beside the
// closest points of the unmodified surfaces. Their shares are as alike as rounded windows make their cells.
TEST(LightLoad, PairsThatAreAlikeShareAlike)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, example_flanks(pair), {}, {}, 41);
  double before = 0;
  for (const double torque : { 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1 }) // N m
    {
      const PositionResult result = mesh.solve(0.5, { 1e3 * torque })[0];
      ASSERT_EQ(result.pairs.size(), 2u) << torque;
      EXPECT_NEAR(load_share(result, result.pairs[0]), 0.5, 4e-3) << torque;
      if (before > 0) // a point contact: pressure goes as the cube root of the load
        EXPECT_NEAR(result.max_pressure / before, std::cbrt(10), 0.04 * std::cbrt(10)) << torque;
      before = result.max_pressure;
    }
}

// Parts of a divided slice stand in one column of the contact pattern: it shows the greatest of them, and
// between positions what lies between the greatest.
TEST(LightLoad, ContactPatternShowsTheGreatestOfADividedSlice)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const LoadedPair mesh = mesh_of(pair, on_pinion(std::make_shared<LeadCrown>(20e-3, 20)), {}, {}, 41);
  std::vector<PositionResult> cycle;
  double least = 1e300;
  for (int k = 0; k < 16; ++k)
    {
      cycle.push_back(mesh.solve(k / 16.0, { 1.0 })[0]);
      if (cycle.back().pairs.size() == 1)
        least = std::min(least, cycle.back().max_pressure);
    }
  const FlankMap pattern = contact_pattern(pair, cycle, 41);
  const double from = cycle[0].max_pressure_roll, to = cycle[1].max_pressure_roll;
  for (std::size_t i = 0; i < pattern.roll.size(); ++i)
    if (pattern.roll[i] > from && pattern.roll[i] < to)
      EXPECT_GT(pattern.value(static_cast<Eigen::Index>(i), 20), 0.9 * least) << pattern.roll[i];
  EXPECT_NEAR(to - from, 2 * units::pi / 50 / 16, 1e-3);
}

// A wedge: the contact begins exactly where a linear relief does. It costs no more slices than a smooth one.
TEST(LightLoad, AKinkNeedsNoMoreSlicesThanAnEllipse)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const LoadedPair mesh = mesh_of(pair, example_flanks(pair), {}, {}, 31);
  for (const double phase : { 0.25, 0.75 })
    for (const double torque : { 1e-6, 1e-4, 1e-2 }) // N m
      EXPECT_LT(mesh.solve(phase, { 1e3 * torque })[0].cells, 11 * 60) << torque;
}

TEST(Grid, WithoutCellsIsRefusedWithAWord)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const LoadedPair mesh = mesh_of(pair);
  PositionCompliance compliance(mesh.bodies.pinion, mesh.bodies.gear, pair.pinion.flank());
  const MeshPosition position(pair, mesh.deviations, 0);
  EXPECT_THROW(PositionGrid(mesh.bodies, position, compliance,
                            { .all = {}, .undivided = 0, .height = 1, .reach = 0.02 }, 0, 100e3),
               ComputationError);
}

TEST(Grid, LoadsBeyondLinearElasticityAreRefusedWithAWord)
{
  for (const auto &[helix, torque] : { std::pair{ 0.0, 1e9 },
                                       { 0.0, 1e15 },
                                       { 25.232, 1e9 },
                                       { 25.232, 1e12 },
                                       { 25.232, 1e18 } }) // deg, N mm
    {
      const GearPair pair = make_gear_pair(paper_pair(helix));
      try
        {
          mesh_of(pair).solve(0.2, { torque });
          FAIL() << torque;
        }
      catch (const ComputationError &error)
        {
          EXPECT_NE(std::string(error.what()).find("lower the torque"), std::string::npos) << error.what();
        }
    }
}

TEST(Grid, ResolvesAContactThatReliefHasMovedAside)
{
  // At 1 N m against 60 um of relief the contact is far narrower than its distance from the path of action; 5
  // % at most of the load may lie on slices with fewer than 3 cells, which leaves about 1 % of the approach.
  const GearPair pair = make_gear_pair(paper_pair(0));
  MeshDeviations deviations = late_relief(pair);
  deviations.pinion.modifications = { std::make_shared<ProfileRelief>(
      "tip relief", 60e-3, 23.6 * degree, pair.pinion.tip_roll, ReliefShape::linear,
      pair.pinion.base_radius) };
  LoadedPair mesh = mesh_of(pair, deviations);
  for (const double phase : { 0.4375, 0.5, 0.5625 })
    {
      mesh.bodies.grid = small_grid;
      const double theta = mesh.solve(phase, { 1e3 })[0].theta - mesh.unloaded(phase).theta;
      mesh.bodies.grid.profile_cells = 45;
      EXPECT_NEAR(theta, mesh.solve(phase, { 1e3 })[0].theta - mesh.unloaded(phase).theta, 0.03 * theta)
          << phase;
    }
}
