// SPDX-License-Identifier: GPL-2.0-or-later
// The keys under which operators of bodies are kept, and cells are shared.
#include "cases/work/body_store.hpp"
#include "contact/loaded/position_grid.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>

using namespace flank;

// Whatever shapes or stiffens a body, or says how it is reduced, is in the key of its operator; a tip edge or
// a name is not.
TEST(OperatorKey, SeesEveryFieldThatTheOperatorDependsOn)
{
  const BodyDefinition base{ .gear = make_gear_pair(paper_pair(15)).pinion,
                             .resolution = {},
                             .model = {},
                             .max_offset = 3,
                             .near_field = {} };
  // All that there are: a new one does not compile until it is named here, and changed below.
  [[maybe_unused]] const auto &[degree, flank_rows, tooth_columns, face_layers, fillet_rows, fillet_columns,
                                root_land_columns, rim_layers] = base.resolution;
  [[maybe_unused]] const auto &[kind, segment_teeth, clamped_cuts, reduction, use_mid_plane] = base.model;
  [[maybe_unused]] const auto &[split, depth, free_ends, points] = base.near_field;
  using Change = std::function<void(BodyDefinition &)>;
  const std::vector<Change> changes = {
    [](BodyDefinition &r) { r.gear.teeth += 1; },
    [](BodyDefinition &r) { r.gear.face_width *= 1.001; },
    [](BodyDefinition &r) { r.gear.tip_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.root_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.bore_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.fillet_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.tip_chamfer = 0.1; },
    [](BodyDefinition &r) { r.gear.youngs_modulus *= 1.001; },
    [](BodyDefinition &r) { r.gear.poissons_ratio *= 1.001; },
    [](BodyDefinition &r) { r.gear.reference_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.base_radius *= 1.001; },
    [](BodyDefinition &r) { r.gear.helix_angle *= 1.001; },
    [](BodyDefinition &r) { r.gear.base_helix_angle *= 1.001; },
    [](BodyDefinition &r) { r.gear.half_angle_at_base *= 1.001; }, // the tooth thickness
    [](BodyDefinition &r) { r.resolution.degree += 1; },
    [](BodyDefinition &r) { r.resolution.flank_rows += 1; },
    [](BodyDefinition &r) { r.resolution.tooth_columns += 2; },
    [](BodyDefinition &r) { r.resolution.face_layers += 1; },
    [](BodyDefinition &r) { r.resolution.fillet_rows += 1; },
    [](BodyDefinition &r) { r.resolution.fillet_columns += 1; },
    [](BodyDefinition &r) { r.resolution.root_land_columns += 1; },
    [](BodyDefinition &r) { r.resolution.rim_layers += 1; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment, r.model.segment_teeth = 5; },
    [](BodyDefinition &r) { r.model.kind = BodyModel::Kind::segment, r.model.clamped_cuts = true; },
    [](BodyDefinition &r) { r.model.reduction = BodyModel::Reduction::direct; },
    [](BodyDefinition &r) { r.model.use_mid_plane = false; },
    [](BodyDefinition &r) { r.max_offset += 1; },
    [](BodyDefinition &r) { r.near_field.points += 1; },
    [](BodyDefinition &r) { r.near_field.free_ends = false; },
    [](BodyDefinition &r) { r.near_field.split = Split::classical; },
    [](BodyDefinition &r) {
      r.near_field.split = Split::classical, r.near_field.depth = ClassicalDepth::line_fit;
    },
  };
  std::map<std::string, std::size_t> keys{ { operator_key(base), changes.size() } };
  for (std::size_t k = 0; k < changes.size(); ++k)
    {
      BodyDefinition changed = base;
      changes[k](changed);
      const auto [same, is_new] = keys.try_emplace(operator_key(changed), k);
      EXPECT_TRUE(is_new) << "changes " << k << " and " << same->second;
    }
  BodyDefinition other = base;
  other.gear.name = "another name";
  other.gear.tip_rounding = 0.1;
  EXPECT_EQ(operator_key(other), operator_key(base));
}

// Whatever places cells, besides the bodies, is in the identity under which variants of a study share
// compliance.
TEST(CellsIdentity, SeesEveryFieldThatPlacesCells)
{
  const GearPair base = make_gear_pair(paper_pair(15));
  using Change = std::function<void(GearPair &, ContactGridSize &)>;
  const std::vector<Change> changes = {
    [](GearPair &p, ContactGridSize &) { p.data.centre_distance += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.data.axial_offset += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.face_low += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.face_high += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.pinion.usable_tip_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.gear.usable_tip_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.pinion.tip_rounding += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.gear.tip_rounding += 1e-3; },
    [](GearPair &p, ContactGridSize &) { p.pinion.form_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.gear.form_roll += 1e-6; },
    [](GearPair &p, ContactGridSize &) { p.data.pinion_hand = Hand::left; },
    [](GearPair &p, ContactGridSize &) { p.data.counter_clockwise_drive = !p.data.counter_clockwise_drive; },
    [](GearPair &, ContactGridSize &g) { g.slices += 2; },
    [](GearPair &, ContactGridSize &g) { g.profile_cells += 2; },
  };
  const std::string same = identity_of_cells(base, {});
  EXPECT_EQ(identity_of_cells(make_gear_pair(paper_pair(15)), {}), same);
  for (std::size_t k = 0; k < changes.size(); ++k)
    {
      GearPair pair = base;
      ContactGridSize grid;
      changes[k](pair, grid);
      EXPECT_NE(identity_of_cells(pair, grid), same) << "change " << k;
    }
}
