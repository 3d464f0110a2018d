// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/stress_below_contact.hpp"
#include "contact/stress/body_field.hpp"
#include "contact/stress/contact_region.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/small_mesh.hpp"
#include "tests/example_pairs.hpp"
#include "tests/solver/displacements.hpp"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <tuple>

using namespace flank;

// Both hands, both senses of drive: where the solver says that flanks touch, the placed bodies must touch,
// normal against normal.
TEST(Fields, PlacedBodiesTouchWhereTheContactIs)
{
  for (const double helix : { 0.0, 25.232 })
    for (const Hand hand : { Hand::right, Hand::left })
      for (const bool counter_clockwise : { true, false })
        {
          PairData data = paper_pair(helix);
          data.pinion_hand = hand;
          data.counter_clockwise_drive = counter_clockwise;
          data.gear.teeth = 50;
          data.axial_offset = 1.5;
          const GearPair pair = make_gear_pair(data);
          const MeshDeviations none;
          for (const double phase : { 0.0, 0.37 })
            {
              int touching = 0;
              const MeshPosition position(pair, none, phase);
              for (const Slice &slice : position.slices(7))
                if (!slice.tip_edge)
                  {
                    ++touching;
                    const Placement pinion = of_tooth(pinion_placement(pair, phase), pair.pinion, slice.pair),
                                    gear = of_tooth(gear_placement(pair, phase), pair.gear, -slice.pair);
                    const double gear_z = canonical_z_sign(data) * data.axial_offset - slice.z;
                    const auto of_pinion = pair.pinion.flank().frame(slice.pinion_roll, slice.z),
                               of_gear = pair.gear.flank().frame(slice.gear_roll, gear_z);
                    EXPECT_LT((pinion.point(of_pinion.origin) - gear.point(of_gear.origin)).norm(),
                              1e-9); // rounding of 150 mm
                    EXPECT_NEAR(pinion.vector(of_pinion.inward).dot(gear.vector(of_gear.inward)), -1, 1e-12);
                    // The contact goes along with the pinion, whose teeth move in +y towards the gear where
                    // it turns counter-clockwise.
                    if (helix == 0)
                      {
                        EXPECT_NEAR(pinion.point(of_pinion.origin).y(),
                                    (counter_clockwise ? 1 : -1) * (phase + slice.pair) *
                                        pair.transverse_base_pitch * std::cos(pair.working_pressure_angle),
                                    1e-9);
                      }
                  }
              EXPECT_GE(touching, 7);
            }
          EXPECT_NEAR(gear_placement(pair, 0).offset.z(), data.axial_offset, 1e-12);
        }
}

TEST(Fields, SurfaceDataAndFlankLoadsSumToTheSolversForces)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const auto &body = small_body(25.232);
  LoadedPair mesh = small_loaded_pair(pair, body, body);
  mesh.keep_cells = true;
  const PositionResult result = mesh.solve(0.3, { 2e5 }).front();
  double force = 0, of_field[2] = { 0, 0 }, torque = 0;
  for (const PairLoad &load : result.pairs)
    force += load.force;
  const FieldPiece field = contact_field(pair, result);
  for (const Eigen::MatrixXd &cell : field.cells)
    {
      of_field[cell(7, 0) == 1 ? 0 : 1] += cell(3, 0) * cell(6, 0); // pressure times area
      for (const PairLoad &load : result.pairs)
        if (load.pair == static_cast<int>(cell(8, 0)))
          {
            EXPECT_NEAR(cell(9, 0), load.force / force, 1e-12);
          }
    }
  // Of every body: gaps in the order of the cells; a cell's sides along the generator are as long as the
  // generator is straight.
  const auto count = static_cast<std::size_t>(result.contact_gap.size());
  ASSERT_EQ(field.cells.size(), 2 * count);
  for (std::size_t i = 0; i < field.cells.size(); ++i)
    {
      const Eigen::MatrixXd &cell = field.cells[i];
      const ContactCell &of = (*result.contact_cells)[i % count];
      const Patch &own = i < count ? of.pinion : of.gear;
      EXPECT_NEAR(cell(4, 0), 1e3 * result.contact_gap[static_cast<Eigen::Index>(i % count)],
                  1e-9); // um of mm
      for (const int corner : { 0, 1 })
        EXPECT_NEAR((cell.col(corner + 2) - cell.col(corner)).head<3>().norm(), 2 * own.half_generator,
                    1e-3 * own.half_generator); // beside the generator, by the flank's curvature
    }
  EXPECT_NEAR(of_field[0], force, 1e-12 * force);
  EXPECT_NEAR(of_field[1], force, 1e-12 * force);
  for (const Side side : { Side::pinion, Side::gear })
    for (const auto &[tooth, load] : flank_loads(body.far_field().surface, result, side))
      for (const PairLoad &of_pair : result.pairs)
        if (of_pair.pair == (side == Side::pinion ? tooth : -tooth))
          {
            EXPECT_NEAR(load.sum(), of_pair.force, 1e-12 * force);
          }
  // No gap where there is force, no force where there is a gap.
  for (Eigen::Index i = 0; i < result.contact_gap.size(); ++i)
    {
      EXPECT_LT(std::abs(result.contact_gap[i] * result.contact_force[i]), 1e-12 * force);
      EXPECT_GT(result.contact_gap[i], -1e-12);
      torque += result.contact_force[i] * (*result.contact_cells)[static_cast<std::size_t>(i)].lever;
    }
  EXPECT_NEAR(torque, 2e5, 1e-6);
}

// A spur pair at the pitch point: one line contact with the radii of the involutes there.
TEST(Fields, StressBelowASpurContactIsHertzs)
{
  const GearPair pair = make_gear_pair(paper_pair(0));
  const auto &body = small_body(0);
  LoadedPair mesh = small_loaded_pair(pair, body, body);
  EXPECT_TRUE(mesh.solve(0, { 2e5 }).front().measured.empty()); // nobody asked
  half_space::SubsurfaceStress below;
  mesh.measures["below"] = [&](const GearPair &of, const std::vector<ContactCell> &cells,
                               const Eigen::VectorXd &force, const Eigen::VectorXd &pressure) {
    below = below_greatest_pressure(of, nullptr, cells, force, pressure);
    return std::vector{ below.shear };
  };
  const PositionResult result = mesh.solve(0, { 2e5 }).front();
  ASSERT_EQ(result.pairs.size(), 1u);
  double line_load = 0; // where the greatest pressure is
  for (const LineLoad &line : result.lines)
    if (std::abs(line.z - result.max_pressure_z) < 1e-9)
      line_load = line.load_per_length;
  const double modulus = 207e3 / (1 - 0.09) / 2,
               radius = pair.pinion.base_radius * std::tan(pair.working_pressure_angle) / 2;
  const double half_width = std::sqrt(4 * line_load * radius / (units::pi * modulus)),
               peak = 2 * line_load / (units::pi * half_width);
  // Eleven cells over the window, seven of them loaded: their means broaden the contact.
  EXPECT_NEAR(below.shear, 0.30028 * peak, 0.02 * 0.30028 * peak);
  EXPECT_NEAR(below.shear_depth, 0.78615 * half_width, 0.04 * 0.78615 * half_width);
  EXPECT_NEAR(below.von_mises, 0.5577 * peak, 0.02 * 0.5577 * peak);
}

namespace
{
  /// Elements of a tooth that is held at its cuts and at the bore.
  struct HeldTooth
  {
    HeldTooth(const Gear &gear, const SectorResolution &size)
        : elements(gear, size)
    {
      std::vector<char> held = bore_unknowns(elements.sector(), elements.body());
      for (const bool plus : { true, false })
        for (const int node : cut_nodes(elements.sector(), elements.body(), plus))
          std::fill_n(held.begin() + 3 * node, 3, 1);
      solver = make_direct_solver(elements.body().stiffness(), held);
    }
    const BodyElements elements;
    std::unique_ptr<const DirectSolver> solver;
  };

  /// A narrow tooth, its flank in six by three elements and in elements a third as long.
  struct NarrowTooth
  {
    explicit NarrowTooth(const double helix)
        : gear(narrow(helix))
        , edges(gear)
        , coarse(gear, size(1))
        , fine(gear, size(3))
        , region(coarse.elements)
    {
    }

    static Gear narrow(const double helix)
    {
      Gear gear = make_gear_pair(paper_pair(helix)).pinion;
      gear.face_width = 6;
      return gear;
    }

    static SectorResolution size(const int times)
    {
      SectorResolution result;
      result.rim_layers = 3;
      result.flank_rows = 6 * times, result.tooth_columns = 4 * times, result.face_layers = 3 * times;
      return result;
    }

    const Gear gear;
    const FlankEdges edges;
    const HeldTooth coarse, fine;
    const ContactRegion region;
  };

  /// All of an element of the flank, pressed evenly; it is three by three fine elements.
  struct PressedElement
  {
    PressedElement(const NarrowTooth &tooth, const int row, const int layer)
        : row(row)
        , layer(layer)
    {
      const FlankSurface surface = flank_surface(tooth.coarse.elements.sector());
      const double q_step = (surface.q_tip - surface.q_form) / surface.rows,
                   q = surface.q_tip - (row + 0.5) * q_step, z = 2 * (layer - 1);
      const InvoluteHelicoid flank = tooth.gear.flank();
      const double a = flank.base_radius() / 2 * q_step / 2, b = 1 / flank.cos_base_helix(),
                   q_half = q_step / 2;
      pressure = force / (4 * a * b);
      patch = {
        0,
        { { q + q_half, z - 1 }, { q + q_half, z + 1 }, { q - q_half, z + 1 }, { q - q_half, z - 1 } },
        std::sqrt(q),
        z,
        a,
        b
      };
    }
    static constexpr double force = 1000;
    int row, layer;
    double pressure = 0;
    Patch patch;
  };

  struct Solved
  {
    Eigen::VectorXd displacement, nodal;
    NearLoads loads;
  };

  Solved under(const PressedElement &pressed, const NarrowTooth &tooth, const HeldTooth &held,
               const FlankEdges *edges)
  {
    const BodyElements &elements = held.elements;
    const FlankSurface own = flank_surface(elements.sector());
    NearLoads loads(tooth.gear, own, edges);
    loads.add(pressed.patch, PressedElement::force);
    const PatchWeights w(own, { pressed.patch });
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(own.n_nodes());
    for (std::size_t k = 0; k < w.nodes(0).size(); ++k)
      nodal[w.nodes(0)[k]] += PressedElement::force * w.values(0)[k];
    Eigen::VectorXd load = Eigen::VectorXd::Zero(elements.body().n_unknowns());
    const Eigen::Matrix3Xd normals = flank_normals(elements.sector(), own);
    const auto nodes = flank_nodes(elements.sector(), own, elements.body());
    for (Eigen::Index i = 0; i < normals.cols(); ++i)
      load.segment<3>(3 * nodes[i]) += nodal[i] * normals.col(i);
    return { held.solver->solve(load), nodal, loads };
  }

  /// Differences of stresses over the pressure.
  struct Apart
  {
    double joined = 0,   ///< the half-space and coarse elements together, from the fine elements
        elements = 0,    ///< the coarse elements alone, likewise
        jump_at_cut = 0; ///< the former from the latter where the coarse elements go on alone
  };

  std::pair<Eigen::Vector3d, Eigen::Matrix3d> stress_at(const ElasticBody &body, const int cell,
                                                        const Eigen::Vector3d &reference,
                                                        const Eigen::VectorXd &u)
  {
    std::pair<Eigen::Vector3d, Eigen::Matrix3d> result;
    body.each_sample({ cell }, { reference }, u, [&](int, const ElasticBody::Samples &s) {
      result = { s.position.col(0), stress_tensor(s.stress.col(0)) };
    });
    return result;
  }

  Apart apart(const NarrowTooth &tooth, const PressedElement &pressed, const Solved &fine,
              const FlankEdges *edges)
  {
    const Solved coarse = under(pressed, tooth, tooth.coarse, edges);
    const Eigen::VectorXd without_contact =
        tooth.region.without_contact(coarse.displacement, coarse.nodal, coarse.loads);
    const auto [row, layer] = std::pair(pressed.row, pressed.layer);
    Apart result;
    for (int column = 0; column < 3; ++column)
      for (int part = 0; part < 3; ++part)
        {
          const int cell = tooth.coarse.elements.sector().tooth_cell(row, column, layer);
          const auto [x, fine_stress] = stress_at(
              tooth.fine.elements.body(),
              tooth.fine.elements.sector().tooth_cell(3 * row + 1, 3 * column + part, 3 * layer + 1),
              { 0.5, 0.5, 0.5 }, fine.displacement);
          const Eigen::Vector3d reference(0.5, (part + 0.5) / 3, 0.5);
          const auto [y, elements] =
              stress_at(tooth.coarse.elements.body(), cell, reference, coarse.displacement);
          // The same point but for the interpolation of the profile.
          EXPECT_LT((x - y).norm(), 0.02) << row << ' ' << layer << ' ' << column << ' ' << part;
          const Eigen::Matrix3d joined =
              stress_at(tooth.region.body(), tooth.region.of_sector_cell(cell), reference, without_contact)
                  .second +
              coarse.loads.at(y).stress;
          result.joined = std::max(result.joined, (joined - fine_stress).cwiseAbs().maxCoeff());
          result.elements = std::max(result.elements, (elements - fine_stress).cwiseAbs().maxCoeff());
        }
    const SectorResolution &size = tooth.coarse.elements.sector().resolution;
    for (int at_layer = 0; at_layer < size.face_layers; ++at_layer)
      for (int at_row = 0; at_row < size.flank_rows; ++at_row)
        {
          const int cell = tooth.coarse.elements.sector().tooth_cell(at_row, 2, at_layer);
          const Eigen::Vector3d reference(0.5, 1, 0.5);
          const auto [x, plain] =
              stress_at(tooth.coarse.elements.body(), cell, reference, coarse.displacement);
          const auto [y, without] =
              stress_at(tooth.region.body(), tooth.region.of_sector_cell(cell), reference, without_contact);
          result.jump_at_cut = std::max(result.jump_at_cut,
                                        (without + coarse.loads.at(y).stress - plain).cwiseAbs().maxCoeff());
        }
    result.joined /= pressed.pressure, result.elements /= pressed.pressure,
        result.jump_at_cut /= pressed.pressure;
    return result;
  }
} // namespace

// A pressed patch no larger than an element: what the half-space and coarse elements say together, against
// elements a third as long alone: inside the flank, and at its ends and its tip, which are free.
TEST(Fields, HalfSpaceJoinsTheElementsBelowAContact)
{
  struct Place
  {
    const char *name;
    int row, layer;
    // Allowed, over the pressure: what elements a third as long leave themselves, and the elements' error of
    // a field that has no peak at the cut; at the tip elements are as wide as the tooth there.
    double joined, jump;
    double elements; ///< the elements alone are so many times as far off
  };
  for (const double helix : { 0.0, 25.232 })
    {
      const NarrowTooth tooth(helix);
      for (const Place &place :
           { Place{ "inside", 2, 1, 0.03, 0.02, 3 }, Place{ "low end", 2, 0, 0.04, 0.02, 3 },
             Place{ "high end", 2, 2, 0.04, 0.02, 3 }, Place{ "tip", 0, 1, 0.06, 0.06, 3 },
             Place{ "corner", 0, 0, 0.06, 0.06, 2 } })
        {
          const PressedElement pressed(tooth, place.row, place.layer);
          const Solved fine = under(pressed, tooth, tooth.fine, nullptr);
          const Apart with = apart(tooth, pressed, fine, &tooth.edges),
                      without = apart(tooth, pressed, fine, nullptr);
          std::cout << helix << ' ' << place.name << ": " << with.joined << ", half-space to the edge "
                    << without.joined << ", of the elements alone " << with.elements << ", jump at the cut "
                    << with.jump_at_cut << ", " << without.jump_at_cut << "\n";
          EXPECT_LT(with.joined, place.joined) << helix << ' ' << place.name;
          EXPECT_LT(with.jump_at_cut, place.jump) << helix << ' ' << place.name;
          EXPECT_GT(with.elements, place.elements * with.joined) << helix << ' ' << place.name;
          // The acute end of a helical gear.
          EXPECT_GT(without.joined, (helix > 0 && place.layer == 2 ? 3 : 0) * with.joined);
        }
    }
}

// The same body as a field for ParaView: everywhere one stress in the placed axes, and what follows from it.
TEST(Fields, BodyFieldOfAUniformlyStretchedSector)
{
  const GearPair pair = make_gear_pair(paper_pair(25.232));
  const Gear &gear = pair.pinion;
  const BodyElements elements(gear, small_sector());
  Eigen::VectorXd displacement(elements.body().n_unknowns());
  for (int node = 0; node < elements.body().n_nodes(); ++node) // uniaxial along the face
    {
      const Eigen::Vector3d &x = elements.body().node_positions()[node];
      displacement.segment<3>(3 * node) =
          1e-3 * Eigen::Vector3d(-gear.poissons_ratio * x.x(), -gear.poissons_ratio * x.y(), x.z());
    }
  const ContactRegion region(elements);
  const FieldPiece field = body_field(elements, region, pinion_placement(pair, 0.3), Side::pinion,
                                      { { 0, displacement, {}, nullptr } }, true, true);
  ASSERT_EQ(field.cells.size(), elements.sector().mesh.cells.size());
  const double tension = 1e-3 * gear.youngs_modulus;
  for (const Eigen::MatrixXd &cell : field.cells)
    for (Eigen::Index point = 0; point < cell.cols(); ++point)
      {
        const auto values = cell.col(point);
        const double radius = values.head<2>().norm(), z = values[2];
        EXPECT_NEAR(values.segment<2>(3).norm(), 1e-3 * gear.poissons_ratio * radius, 1e-9);
        EXPECT_NEAR(std::abs(values[5]), 1e-3 * std::abs(z), 1e-9);
        for (int i = 0; i < 9; ++i)
          EXPECT_NEAR(values[6 + i], i == 8 ? tension : 0, 1e-8 * tension);
        EXPECT_NEAR(values[15], tension, 1e-8 * tension); // von Mises
        EXPECT_NEAR(values[16], tension, 1e-8 * tension);
        EXPECT_NEAR(values[17], 0, 1e-8 * tension);
        EXPECT_NEAR(values[18], 0, 1e-8 * tension);
      }
}

// Far from a contact cell its point force stands for it: along a ray stresses fall with the square of the
// distance, across the change too.
TEST(Fields, StressOfACellDoesNotChangeWhereAPointForceStandsForIt)
{
  Gear gear = make_gear_pair(paper_pair(0)).pinion;
  gear.poissons_ratio = 0.4;
  const BodyElements elements(gear, small_sector());
  const FlankSurface surface = flank_surface(elements.sector());
  const double roll = std::sqrt(0.5 * (surface.q_tip + surface.q_form)), half = 0.1;
  const InvoluteHelicoid flank = gear.flank();
  NearLoads loads(gear, surface);
  Patch patch{ 0, {}, roll, 0, half, half };
  for (const auto &[x, y] : { std::pair{ -half, -half }, { half, -half }, { half, half }, { -half, half } })
    patch.outline.emplace_back(roll * roll + 2 * x / gear.base_radius, y);
  loads.add(patch, 100);
  const auto frame = flank.frame(roll, 0);
  for (const Eigen::Vector3d &direction :
       { Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.6, 0, 0.8), Eigen::Vector3d(0.3, 0.8, 0.5) })
    {
      const Eigen::Vector3d along =
          (direction.x() * frame.profile + direction.y() * frame.generator + direction.z() * frame.inward)
              .normalized();
      const auto of_distance = [&](const double r) -> Eigen::Matrix3d {
        return r * r * loads.at(frame.origin + r * along).stress;
      };
      const Eigen::Matrix3d cell = of_distance(5.9 * half), point = of_distance(6.1 * half);
      EXPECT_LT((cell - point).norm(),
                0.06 * cell.norm()); // (half / distance)^2 of it and a little more: 2.8 to 5 %
    }
}
