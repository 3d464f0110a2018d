// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/half_space.hpp"
#include "contact/matching/body_compliance.hpp"
#include "contact/matching/source_table.hpp"
#include "contact/wedge/edge_field.hpp"
#include "contact/wedge/strip_means.hpp"
#include "mesh/base/units.hpp"
#include "tests/example_pairs.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>

using namespace flank;

namespace
{
  Gear narrow_gear(const double helix_angle_deg, const double poissons_ratio = 0.45,
                   const double tip_chamfer = 0)
  {
    PairData data = paper_pair(helix_angle_deg);
    for (GearData *gear : { &data.pinion, &data.gear })
      {
        gear->face_width = 6, gear->youngs_modulus = 100e3, gear->poissons_ratio = poissons_ratio;
        gear->tip_chamfer = tip_chamfer;
      }
    return make_gear_pair(data).pinion;
  }

  SectorResolution resolution(const int degree, const int rows, const int columns, const int layers)
  {
    SectorResolution size;
    size.degree = degree, size.flank_rows = rows, size.tooth_columns = columns, size.face_layers = layers;
    size.rim_layers = 7;
    return size;
  }

  /// Rectangle of half-sides a along the profile and b along the generator around a place of the flank.
  Patch rectangle(const Gear &gear, const double roll, const double z, const double a, const double b)
  {
    const InvoluteHelicoid flank = gear.flank();
    Patch patch{ 0, {}, roll, z, a, b };
    for (const auto &[x, y] : { std::pair{ -a, -b }, { a, -b }, { a, b }, { -a, b } })
      patch.outline.emplace_back(std::pow(roll + y * flank.roll_per_generator(), 2) +
                                     2 * x / gear.base_radius,
                                 z + y * flank.cos_base_helix());
    return patch;
  }

  /// Mean displacement of a patch under its own unit load, by the elements alone. [mm/N]
  double by_elements(const FlankCompliance &compliance, const Patch &patch)
  {
    const PatchWeights weights(compliance.surface, { patch });
    const auto nodes = weights.nodes(0);
    const auto values = weights.values(0);
    double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = 0; j < nodes.size(); ++j)
        sum += values[i] * values[j] * compliance.by_tooth_offset[0](nodes[i], nodes[j]);
    return sum;
  }

  /// The same with the near field. [mm/N]
  double by_split(const BodyCompliance &body, const Gear &gear, const Patch &patch)
  {
    const PatchGroup group = body.group({ patch });
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(1, 1);
    body.add_far(group, { &group }, { &c });
    body.add_near(group, group, patch_potentials({ patch }, { patch }, gear.flank()), c, nullptr);
    return c(0, 0);
  }

  /// Mean displacement of a patch under a unit load on another, by elements and near field. [mm/N]
  double coupling(const BodyCompliance &body, const Gear &gear, const Patch &load, const Patch &output)
  {
    const PatchGroup of_load = body.group({ load }), of_output = body.group({ output });
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(1, 1);
    body.add_far(of_load, { &of_output }, { &c });
    if (body.is_near(of_output, of_load))
      body.add_near(of_output, of_load, patch_potentials({ output }, { load }, gear.flank()), c, nullptr);
    return c(0, 0);
  }
} // namespace

// Patches that touch the tip edge, down to a hundredth of an element: what one yields more than one a third
// of its size at the same place is of the edge's surroundings alone, whose field that of a wedge is.
TEST(ProjectedSplit, SmallPatchesAtTheTipEdgeAgainstAWedge)
{
  const Gear gear = narrow_gear(0, 0.3);
  const BodyCompliance body(gear, resolution(2, 6, 4, 4), 1);
  const double opening = units::pi / 2 + std::atan(gear.tip_roll), e = gear.youngs_modulus,
               nu = gear.poissons_ratio, b = 0.02;
  const wedge::FaceTable face = wedge::EdgeField(opening, nu).face();
  for (const double distance : { 0.1, 0.03, 0.01 })
    {
      const auto by_wedge = [&](const double a) {
        const wedge::Strip strip{ distance - a, distance + a };
        return half_space::surface_compliance(e, nu) *
                   half_space::mean_love_potential({ 0, 0, a, b }, { 0, 0, a, b }) +
               wedge::StripMeans(face, strip, strip).mean(0, b, b) / e;
      };
      const double roll = std::sqrt(std::pow(gear.tip_roll, 2) - 2 * distance / gear.base_radius);
      const auto by_body = [&](const double a) {
        return by_split(body, gear, rectangle(gear, roll, 0.2, a, b));
      };
      const double large = distance, small = 0.3 * distance, own = by_wedge(large);
      EXPECT_NEAR(by_body(small) - by_body(large), by_wedge(small) - own, 1e-3 * own) << distance;
    }
}

// What does not change with the mesh is right, at tip edges too: patches that touch them, on six rows of
// elements against eighteen. Elements alone make them up to 9 % too stiff.
TEST(ProjectedSplit, TipEdgesDoNotDependOnTheElements)
{
  for (const double helix : { 0.0, 25.232 })
    {
      const Gear gear = narrow_gear(helix, 0.3);
      const BodyCompliance coarse(gear, resolution(2, 6, 4, 4), 1), fine(gear, resolution(2, 18, 6, 4), 1),
          elements(gear, resolution(2, 6, 4, 4), 1, { .free_ends = false });
      const double slope = gear.base_radius * gear.tip_roll * std::abs(gear.flank().roll_per_generator());
      for (const auto &[a, b, missed] :
           { std::tuple{ 0.1, 0.03, 0.01 }, { 0.03, 0.25, 0.005 }, { 0.01, 0.03, 0.07 } })
        {
          const double roll = std::sqrt(std::pow(gear.tip_roll, 2) - 2 * (a + slope * b) / gear.base_radius);
          const Patch patch = rectangle(gear, roll, 0.2, a, b);
          const double expected = by_split(fine, gear, patch);
          EXPECT_NEAR(by_split(coarse, gear, patch), expected, 3e-3 * expected) << helix << ' ' << a;
          EXPECT_LT(by_split(elements, gear, patch), (1 - missed) * expected) << helix << ' ' << a;
        }
    }
}

// A patch that ends at a chamfer: elements larger than it and the half-space, against elements that resolve
// it. (Less than the patch's own size of steel beyond its edge holds it little: a body with the whole corner
// is within 0.3 % too. What the body is, its area says, in elements_test.)
TEST(ProjectedSplit, OwnComplianceAtAChamferedTip)
{
  const double a = 0.3, b = 0.45;
  const Gear gear = narrow_gear(0, 0.3, 0.5);
  const double roll = std::sqrt(std::pow(gear.usable_tip_roll, 2) - 2 * a / gear.base_radius);
  const Patch patch = rectangle(gear, roll, 0.2, a, b);
  const double split = by_split(BodyCompliance(gear, resolution(2, 6, 4, 4), 1), gear, patch);
  const BodyElements fine(gear, resolution(3, 14, 6, 10));
  const double reference = by_elements(flank_compliance(fine, {}, 1, 0, nullptr, nullptr), patch);
  std::cout << "at a chamfer: " << split / reference << " of elements that resolve the patch\n";
  EXPECT_NEAR(split / reference, 1, 0.006); // as the others above; measured: 1.004
}

// The product's own split on elements larger than the patch, against elements that resolve the patch and no
// half-space at all: inside the flank, at the tip edge, at a face end, in their corner; of steel, and of a
// material that hardly changes its volume, whose elements alone miss less.
TEST(ProjectedSplit, OwnComplianceAgainstElementsThatResolveThePatch)
{
  struct Material
  {
    double poissons_ratio;
    std::array<double, 4> split; ///< allowed at the four places
    double classical_inside, classical_at_edges, missed_by_elements;
  };
  // Measured: 0.9 (0.3 against finer elements), 0.1, 0.15, 0.14 %, and 0.1, 0.4, 0.3, 0.2 %. The reference's
  // own elements leave up to 1.2 % where a patch's border runs through them (steel, inside).
  for (const Material &of : { Material{ 0.3, { 0.015, 0.005, 0.004, 0.004 }, 0.045, 0.08, 0.035 },
                              Material{ 0.45, { 0.005, 0.008, 0.006, 0.006 }, 0.055, 0.095, 0.015 } })
    {
      const Gear gear = narrow_gear(0, of.poissons_ratio);
      const BodyCompliance coarse(gear, resolution(2, 6, 4, 4), 1);
      const BodyCompliance half_element(gear, resolution(2, 6, 4, 4), 1, { .split = Split::classical }),
          line_fit(gear, resolution(2, 6, 4, 4), 1,
                   { .split = Split::classical, .depth = ClassicalDepth::line_fit });
      const BodyElements fine_elements(gear, resolution(3, 16, 6, 12));
      const FlankCompliance fine = flank_compliance(fine_elements, {}, 1, 0, nullptr, nullptr);
      const FlankSurface &s = fine.surface;
      const double a = 0.3, b = 0.45,
                   half = gear.face_width / 2; // mm; elements of 1.1 x 1.5 mm against 0.41 x 0.5 mm
      const double tip = std::sqrt(s.q_tip - 2 * a / gear.base_radius),
                   middle = std::sqrt(0.5 * (s.q_tip + s.q_form));
      auto allowed = of.split.begin();
      for (const auto &[roll, z] :
           { std::pair{ middle, 0.2 }, { tip, 0.2 }, { middle, half - b }, { tip, half - b } })
        {
          const std::string where =
              fmt::format("Poisson's ratio {}, roll angle {}, z {}", of.poissons_ratio, roll, z);
          const Patch patch = rectangle(gear, roll, z, a, b);
          const double split = by_split(coarse, gear, patch), plain = by_elements(coarse.far_field(), patch),
                       reference = by_elements(fine, patch);
          EXPECT_NEAR(split, reference, *allowed++ * reference) << where;
          // Vijayakar's split of the same: edges, which it knows nothing of, cost it twice as much.
          for (const BodyCompliance *classical : { &half_element, &line_fit })
            EXPECT_NEAR(by_split(*classical, gear, patch), reference,
                        (roll == middle && z < 1 ? of.classical_inside : of.classical_at_edges) * reference)
                << where;
          EXPECT_LT(plain, (1 - of.missed_by_elements) * reference) << where;
        }
    }
}

// Strips that touch a face end, of a helical tooth: its ends are wedges of 66 and 114 degrees. The product's
// split on two elements over the face, against elements that resolve the patch. Half-space theory misses 2 %
// at the acute one (measured: 2.2 %).
TEST(ProjectedSplit, EndsOfAHelicalFlankAgainstElementsThatResolveThePatch)
{
  const Gear gear = narrow_gear(25.232, 0.3);
  const BodyCompliance free(gear, resolution(2, 6, 4, 2), 1),
      half_space(gear, resolution(2, 6, 4, 6), 1, { .free_ends = false });
  const BodyElements fine_elements(gear, resolution(3, 12, 4, 12));
  const FlankCompliance fine = flank_compliance(fine_elements, {}, 1, 0, nullptr, nullptr);
  const FlankSurface &s = fine.surface;
  const double a = 0.3, b = 0.45, middle = std::sqrt(0.5 * (s.q_tip + s.q_form));
  for (const int side : { 1, -1 })
    {
      const Patch patch =
          rectangle(gear, middle, side * (gear.face_width / 2 - b * gear.flank().cos_base_helix()), a, b);
      const double reference = by_elements(fine, patch);
      // The reference leaves 1.1 % at both ends, as it does inside the flank, where ends play no part.
      EXPECT_NEAR(by_split(free, gear, patch), reference, 0.015 * reference) << side;
      if (side == 1) // acute
        {
          EXPECT_LT(by_split(half_space, gear, patch), 0.98 * reference);
        }
    }
}

// What does not change with the mesh is right: strips at both ends, long and short, one strip inside and
// beside, of three layers of elements over the face, which are as long as the standard level's, against
// twelve (measured: 0.08 % at most). Half-space theory changes by 4 and 19 % at the acute end.
TEST(ProjectedSplit, FreeEndsDoNotDependOnTheElements)
{
  for (const double helix : { 0.0, 25.232 })
    {
      const Gear gear = narrow_gear(helix, 0.3);
      const BodyCompliance coarse(gear, resolution(2, 8, 4, 3), 1), fine(gear, resolution(2, 8, 4, 12), 1);
      const FlankSurface &s = fine.far_field().surface;
      const double middle = std::sqrt(0.5 * (s.q_tip + s.q_form));
      for (const int side : { 1, -1 })
        for (const auto &[a, b] : { std::pair{ 0.1, 0.25 }, { 0.05, 0.05 } })
          for (const double gap : { 0.0, 0.5 })
            {
              const Patch patch =
                  rectangle(gear, middle,
                            side * (gear.face_width / 2 - (gap + b) * gear.flank().cos_base_helix()), a, b);
              const double expected = by_split(fine, gear, patch);
              EXPECT_NEAR(by_split(coarse, gear, patch), expected, 1e-3 * expected)
                  << helix << ' ' << side << ' ' << gap;
            }
    }
}

// Between patches at an acute end each way round: what is left to symmetrise. And where no block reaches an
// end, ends change nothing at all.
TEST(ProjectedSplit, FreeEndsAreReciprocalAndOfTheEndsAlone)
{
  const Gear gear = narrow_gear(25.232, 0.3);
  const BodyCompliance free(gear, resolution(2, 6, 4, 9), 1),
      half_space(gear, resolution(2, 6, 4, 9), 1, { .free_ends = false });
  const FlankSurface &s = free.far_field().surface;
  const double middle = std::sqrt(0.5 * (s.q_tip + s.q_form)), b = 0.2, cos = gear.flank().cos_base_helix();
  const auto patch = [&](const double from_end, const double roll) {
    return rectangle(gear, roll, gear.face_width / 2 - (from_end + b) * cos, 0.1, b);
  };
  const auto seen = [&](const BodyCompliance &body, const Patch &load, const Patch &output) {
    return coupling(body, gear, load, output);
  };
  for (const auto &[one, other] : { std::pair{ patch(0, middle), patch(0.4, middle) },
                                    { patch(0, middle), patch(0.1, middle + 0.005) },
                                    { patch(0, middle), patch(1.2, middle) } })
    {
      const double forth = seen(free, one, other);
      EXPECT_NEAR(seen(free, other, one), forth, 2e-3 * forth);
    }
  const Patch inside = patch(3.1, middle), beside = patch(3.5, middle);
  EXPECT_EQ(seen(free, inside, beside), seen(half_space, inside, beside));
  EXPECT_EQ(seen(free, patch(0, middle), patch(6, middle)),
            seen(half_space, patch(0, middle), patch(6, middle)));
}

// A spur gear's flank is its own mirror image: tables, strips and blocks at one end are those at the other.
TEST(ProjectedSplit, EndsOfASpurFlankAreAlike)
{
  const Gear gear = narrow_gear(0, 0.3);
  const BodyCompliance body(gear, resolution(1, 3, 2, 3), 1);
  const FlankSurface &s = body.far_field().surface;
  for (const double row : { 0.2, 1.5 })
    for (const double z : { 2.9, 2.45, 1.3, 0.2 })
      for (const double other_z : { 2.9, 1.9, 0.3 })
        {
          const auto at = [&](const double row_at, const double z_at) {
            return rectangle(gear, std::sqrt(s.q_of_row(row_at)), z_at, 0.1, 0.1);
          };
          const double here = coupling(body, gear, at(row, z), at(row + 0.1, other_z));
          EXPECT_NEAR(coupling(body, gear, at(row, -z), at(row + 0.1, -other_z)), here, 1e-12 * here)
              << row << ' ' << z;
        }
}

// A patch that moves over an element's border gets another block: what the cut leaves is what its compliance
// jumps by.
TEST(ProjectedSplit, OwnComplianceDoesNotJumpWhereTheBlockChanges)
{
  const Gear gear = narrow_gear(0);
  const BodyCompliance body(gear, resolution(2, 6, 4, 8), 1);
  const FlankSurface &s = body.far_field().surface;
  const auto at = [&](const double row, const double layer) {
    const double roll = std::sqrt(s.q_of_row(row)), z = s.face_width * (layer / s.layers - 0.5);
    return by_split(body, gear, rectangle(gear, roll, z, 0.1, 0.15));
  };
  for (const double border : { 3.0, 4.0 })
    for (const auto &[before, after] : { std::pair{ at(border - 1e-7, 3.5), at(border + 1e-7, 3.5) },
                                         std::pair{ at(2.5, border - 1e-7), at(2.5, border + 1e-7) } })
      EXPECT_NEAR(after, before, 1.5e-4 * before) << border; // two rings of elements leave 7e-5 here
}

// Slices that share borders with elements: which block a patch has, and which patches lie on it, is not left
// to rounding. Patches with their middle on a border (or an end: half a generator is half an element), and
// as much beside it as builds differ by.
TEST(ProjectedSplit, RoundingDoesNotChooseTheBlock)
{
  const Gear gear = narrow_gear(0);
  const BodyCompliance body(gear, resolution(2, 6, 4, 8), 1);
  const FlankSurface &s = body.far_field().surface;
  const double element = s.face_width / s.layers, a = 0.1, b = element / 2;
  const auto patch = [&](const double layer) {
    const double roll = std::sqrt(s.q_of_row(2.5));
    return rectangle(gear, roll, element * layer - s.face_width / 2, a, b);
  };
  for (const double layer : { 3.0, 3.5, 4.0, 4.5 })
    for (const double shift : { -1e-12, 1e-12 })
      for (const double away : { 0.0, 1.0, 2.0 })
        {
          const auto seen = [&](const double there, const double here) {
            const PatchGroup load = body.group({ patch(there) }), output = body.group({ patch(here) });
            Eigen::MatrixXd c = Eigen::MatrixXd::Zero(1, 1);
            body.add_far(load, { &output }, { &c });
            if (body.is_near(output, load))
              body.add_near(output, load, patch_potentials(output.patches, load.patches, gear.flank()), c,
                            nullptr);
            return c(0, 0);
          };
          const double exact = seen(layer, layer + away);
          EXPECT_NEAR(seen(layer + shift, layer + away), exact, 1e-10 * exact) << layer << ' ' << away;
          EXPECT_NEAR(seen(layer, layer + away + shift), exact, 1e-10 * exact) << layer << ' ' << away;
        }
}

// A quadrature's point in the middle of a patch lies on a border too; the polynomials of a table differ there
// (standard mesh, a middle slice: 1e-9 of the transmission error, by chance of the build).
TEST(PiecewisePolynomial, RoundingDoesNotChooseTheInterval)
{
  const PiecewisePolynomial table({ 0, 1, 1.5, 3 }, 4);
  std::array<double, PiecewisePolynomial::max_points> weight{};
  for (const double off : { -1e-12, 0.0, 1e-12 })
    {
      int first = -1;
      for (const auto &[at, interval] :
           { std::pair(0.0, 0), { 0.5, 0 }, { 1.0, 1 }, { 1.25, 1 }, { 1.5, 2 }, { 3.0, 2 } })
        {
          table.weights(at + off, first, weight);
          EXPECT_EQ(first, 4 * interval) << at << ' ' << off;
        }
    }
}

// A load is the sum of its parts: a long patch along a helical flank against the mean of its pieces, seen
// from beside it. All lie on one element, so one block stands for all; at the tip edge the ends of the
// generator see the free face each in its own way.
TEST(ProjectedSplit, ALongPatchIsTheMeanOfItsPieces)
{
  const Gear gear = narrow_gear(25.232);
  const InvoluteHelicoid flank = gear.flank();
  const BodyCompliance body(gear, resolution(2, 6, 4, 2), 1, { .points = 8 });
  const FlankSurface &s = body.far_field().surface;
  const double a = 0.1, b = 1.2, per_generator = flank.roll_per_generator();
  const double tip = std::sqrt(s.q_tip - 2 * a / gear.base_radius) - b * std::abs(per_generator);
  for (const double roll : { std::sqrt(s.q_of_row(2.5)), tip })
    for (const double side : { -0.8, 0.8 })
      {
        const auto along = [&](const double y, const double half, const double beside = 0) {
          const double q = std::pow(roll + y * per_generator, 2) + 2 * beside / gear.base_radius;
          return body.group(
              { rectangle(gear, std::sqrt(q), s.face_width / 4 + y * flank.cos_base_helix(), a, half) });
        };
        const PatchGroup seen_from = along(side * b, 0.15, -0.3);
        const auto seen = [&](const PatchGroup &load) {
          Eigen::MatrixXd c = Eigen::MatrixXd::Zero(1, 1);
          body.add_far(load, { &seen_from }, { &c });
          body.add_near(seen_from, load, patch_potentials(seen_from.patches, load.patches, flank), c,
                        nullptr);
          return c(0, 0);
        };
        double mean = 0;
        for (const double part : { -0.75, -0.25, 0.25, 0.75 })
          mean += seen(along(part * b, b / 4)) / 4;
        EXPECT_NEAR(seen(along(0, b)), mean, 7e-4 * mean)
            << roll; // points in the place of the pressure leave 4e-4
      }
}
