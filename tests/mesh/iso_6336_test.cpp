// SPDX-License-Identifier: GPL-2.0-or-later
// Mesh stiffness and root stress of ISO 6336 against the standard's own formulas.
#include "mesh/base/units.hpp"
#include "mesh/gear/iso_6336.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

using namespace flank;
using units::degree;

TEST(IsoStiffness, WorkedExampleOfTheTechnicalReport) // ISO/TR 6336-30
{
  const double beta = 15.8 * degree;
  const IsoStiffness c = iso_6336_stiffness(17, 103, 0.145, 0, beta, 20 * degree, 1.4, 1.549, 1);
  EXPECT_NEAR(c.theoretical, 17.8558, 0.005); // the report's rounding of its inputs
  EXPECT_NEAR(c.single, 12.3705, 0.005);
}

// ISO 6336-1:2006, equations 82 to 88, written out: both shifts, helical, another rack.
TEST(IsoStiffness, ByTheStandardsEquationsForShiftedHelicalTeeth)
{
  const double z1 = 19, z2 = 61, x1 = 0.31, x2 = -0.22, beta = 27 * degree, alpha = 17.5 * degree,
               contact_ratio = 1.37;
  const double base = std::asin(std::sin(beta) * std::cos(alpha)),
               zn1 = z1 / (std::pow(std::cos(base), 2) * std::cos(beta)), zn2 = zn1 * z2 / z1;
  double flexibility = 0.04723 + 0.15551 / zn1 + 0.25791 / zn2; // C1 to C3
  flexibility += -0.00635 * x1 - 0.11654 * x1 / zn1;            // C4, C5
  flexibility += -0.00193 * x2 - 0.24188 * x2 / zn2;            // C6, C7
  flexibility += 0.00529 * std::pow(x1, 2) + 0.00182 * std::pow(x2, 2);
  const double rack = (1 + 0.5 * (1.2 - 1.4)) * (1 - 0.02 * (20 - 17.5)),
               single = 0.8 * rack * std::cos(beta) / flexibility * 0.7;
  const IsoStiffness c = iso_6336_stiffness(z1, z2, x1, x2, beta, alpha, 1.4, contact_ratio, 0.7);
  EXPECT_NEAR(c.theoretical, 1 / flexibility, 1e-9);
  EXPECT_NEAR(c.single, single, 1e-9);
  EXPECT_NEAR(c.mesh, (0.75 * contact_ratio + 0.25) * single, 1e-9);
}

TEST(IsoStiffness, OfAPairReadsBothGears)
{
  PairData data = paper_pair(15);
  data.pinion.youngs_modulus = 206e3;
  data.gear.youngs_modulus = 206e3;
  const IsoStiffness of_steel = iso_6336_stiffness(make_gear_pair(data));
  data.gear.youngs_modulus = 103e3; // 2 * 206 * 103 / (206 + 103) = 2/3 of 206
  const GearPair pair = make_gear_pair(data);
  const IsoStiffness mixed = iso_6336_stiffness(pair);
  EXPECT_NEAR(mixed.theoretical, of_steel.theoretical, 1e-9);
  EXPECT_NEAR(mixed.single, 2.0 / 3 * of_steel.single, 1e-9);
  EXPECT_NEAR(mixed.mesh, mixed.single * (0.75 * pair.transverse_contact_ratio + 0.25), 1e-9);
}

TEST(IsoRootStress, OfEachGearIsThatOfThePairExchanged)
{
  const PairData data = unequal_pair();
  PairData swapped = data;
  std::swap(swapped.pinion, swapped.gear);
  const GearPair pair = make_gear_pair(data), other = make_gear_pair(swapped);
  const auto here = iso_6336_nominal_root_stress(pair, 100e3),
             there = iso_6336_nominal_root_stress(other, 112e3);
  EXPECT_NEAR(here[0], there[1], 1e-9 * here[0]);
  EXPECT_NEAR(here[1], there[0], 1e-9 * here[1]);
  EXPECT_GT(std::abs(here[0] / here[1] - 1), 1e-3);
}

// Teeth of the standard's basic rack (1.25 m deep, tip radius 0.38 m): its own formulas for the trochoid
// (6.2.2, H, G, theta) against ours, which read the drawn tooth, whose fillet is an arc of the radius that
// the trochoid has at the 30 degree tangent.
TEST(IsoRootStress, FormFactorOfTheBasicRack)
{
  for (const double helix : { 0.0, 25.232 })
    for (const int teeth : { 30, 50, 90 })
      {
        PairData data = paper_pair(helix);
        const double mt = data.transverse_module, beta = helix * degree, m = mt * std::cos(beta);
        const double alpha = std::atan(std::tan(data.transverse_pressure_angle) * std::cos(beta));
        const double sine = std::sin(beta) * std::cos(alpha),
                     zn = teeth / ((1 - sine * sine) * std::cos(beta));
        const double depth = 1.25, rho = 0.38;
        const double e = units::pi / 4 - depth * std::tan(alpha) -
                         (1 - std::sin(alpha)) * rho / std::cos(alpha),
                     g = rho - depth, h = 2 / zn * (units::pi / 2 - e) - units::pi / 3;
        double theta = units::pi / 6;
        for (int i = 0; i < 100; ++i)
          theta = 2 * g / zn * std::tan(theta) - h;
        const double chord =
                         zn * std::sin(units::pi / 3 - theta) + std::sqrt(3.0) * (g / std::cos(theta) - rho),
                     round = rho +
                             2 * g * g / (std::cos(theta) * (zn * std::cos(theta) * std::cos(theta) - 2 * g));
        for (GearData *gear : { &data.pinion, &data.gear })
          {
            gear->teeth = teeth;
            gear->tip_radius = mt * teeth / 2 + m;
            gear->root_radius = mt * teeth / 2 - depth * m;
            gear->tooth_thickness = units::pi * mt / 2;
            gear->fillet_radius = round * m;
            gear->bore_radius = 0.6 * gear->root_radius;
          }
        data.gear.tooth_thickness -= 0.1; // backlash
        data.centre_distance = mt * teeth;
        const GearPair pair = make_gear_pair(data);
        const IsoRootStress ours = iso_6336_root_stress(pair, pair.pinion);
        EXPECT_NEAR(ours.root_chord / m, chord, 0.02 * chord)
            << teeth << " " << helix; // an arc instead of the trochoid
        const auto involute = [](const double angle) { return std::tan(angle) - angle; };
        const double ratio = pair.transverse_contact_ratio / (1 - sine * sine), dn = zn,
                     dbn = dn * std::cos(alpha), dan = dn + 2;
        const double den = 2 * std::hypot(std::sqrt(dan * dan - dbn * dbn) / 2 -
                                              units::pi * std::cos(alpha) * (ratio - 1),
                                          dbn / 2),
                     at_load = std::acos(dbn / den),
                     aside = units::pi / 2 / zn + involute(alpha) - involute(at_load),
                     direction = at_load - aside;
        const double arm = 0.5 * ((std::cos(aside) - std::sin(aside) * std::tan(direction)) * den -
                                  zn * std::cos(units::pi / 3 - theta) - (g / std::cos(theta) - rho));
        EXPECT_NEAR(ours.bending_arm / m, arm,
                    0.04 *
                        arm); // the arc ends on the root circle a little higher than the trochoid: 0.03 of m
        const double form = 6 * arm * std::cos(direction) / (chord * chord * std::cos(alpha));
        EXPECT_NEAR(ours.form_factor, form, 0.03 * form);
        const double slender = chord / arm, notch = chord / (2 * round); // 7.3: L, q_s
        const double correction = (1.2 + 0.13 * slender) * std::pow(notch, 1 / (1.21 + 2.3 / slender));
        EXPECT_NEAR(ours.stress_correction, correction, 0.03 * correction);
        EXPECT_NEAR(ours.helix_factor, 1 - std::min(1.0, pair.overlap_ratio) * helix / 120, 1e-12);
      }
}
