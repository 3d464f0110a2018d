// SPDX-License-Identifier: GPL-2.0-or-later
// Tables, design torques and the records of positions, as what they are made of says.
#include "cases/parallel_axis/pair/position_record.hpp"
#include "cases/results/bounds_over_torque.hpp"
#include "cases/results/design_torques.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/results/transmission_error_curve.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

using namespace flank;

TEST(ResultTable, WritesWholeNumbersWordsAndEmptyFields)
{
  ResultTable table("t", "# heading\n",
                    { { "pair", "1", "{}" },
                      { "body", "", "{}", { "pinion", "gear" } },
                      { "depth_um", "um", "{:.2f}" },
                      torque_column() });
  EXPECT_TRUE(table.empty());
  table.add({ -1, 1, 2.345, 90.01 });
  table.add({ 3, 0, std::numeric_limits<double>::quiet_NaN(), 1e-9 });
  EXPECT_EQ(table.csv(), "# heading\nvariant,pair,body,depth_um,torque_Nm\n"
                         "0,-1,gear,2.35,90.01\n"
                         "0,3,pinion,,1e-09\n");
  EXPECT_ANY_THROW(table.add({ 1 })); // a value a column
}

namespace
{
  /// TE = T/10 + A(T) cos(2 pi phase) with the parabola A, and a `third` power of torque if asked for, whose
  /// cubics are exact, at torques in any order; T in `unit` [N m].
  std::vector<StudyPoint> parabola(const VariantFrame &frame, const double at, const double least,
                                   const double unit = 1, const double third = 0)
  {
    std::vector<StudyPoint> points;
    for (const double phase : frame.abscissa)
      for (const double torque : frame.loads)
        {
          StudyPoint point{};
          const double c = std::cos(2 * units::pi * phase), d = (torque - at) / unit;
          point.response = 0.1 * torque / unit + (least + 1e-4 * d * d + third * d * d * d) * c;
          point.response_slope = (0.1 + (2e-4 * d + 3 * third * d * d) * c) / unit;
          points.push_back(point);
        }
    return points;
  }
} // namespace

TEST(Plan, WritesTimesAndSizesAsPeopleDo)
{
  EXPECT_EQ(two_digits(0.041), "0.041");
  EXPECT_EQ(two_digits(7), "7");
  EXPECT_EQ(two_digits(99.4), "99");
  EXPECT_EQ(two_digits(99.6), "100");
  EXPECT_EQ(two_digits(266.4), "270");
  EXPECT_EQ(two_digits(123456), "120000");
}

TEST(DesignTorques, AreTheLeastAmplitudesOverTorque)
{
  VariantFrame frame;
  frame.loads = { 100, 50, 200 };
  for (int k = 0; k < 8; ++k)
    frame.abscissa.push_back(k / 8.0);
  frame.period = 8;
  // 17.5/150 of the range from a computed torque; peak-to-peak is twice the amplitude.
  const std::vector<StudyPoint> points = parabola(frame, 117.5, 0.25);
  const std::string text = design_torques(frame, points, std::nullopt, "").csv();
  double a1 = 0, a1_least = 0, peaks = 0, peaks_least = 0;
  ASSERT_EQ(std::sscanf(text.substr(text.find("0,A1")).c_str(), "0,A1,%lf,%lf\n0,peak_to_peak,%lf,%lf", &a1,
                        &a1_least, &peaks, &peaks_least),
            4)
      << text;
  // To rounding: where the slope is nothing. What searches by values alone finds the root of that.
  const std::vector<StudyPoint> lopsided = parabola(frame, 117.5, 0.25, 1, 3e-7);
  const TransmissionErrorCurve curve(frame, lopsided);
  EXPECT_NEAR(curve.torques_of_least_amplitude().at(0).torque, 117.5, 1e-11);
  EXPECT_NEAR(curve.torques_of_least_peak_to_peak().at(0).torque, 117.5, 1e-11);
  EXPECT_EQ(a1, 117.5); // in the table to ten digits
  EXPECT_EQ(peaks, 117.5);
  EXPECT_NEAR(a1_least, 0.25, 1e-9);
  EXPECT_NEAR(peaks_least, 0.5, 1e-9);
  EXPECT_EQ(
      design_torque_line(frame, points),
      "design torques, of least A1: 117.5 N m (0.2500 um); of least peak-to-peak: 117.5 N m (0.5000 um)\n");
  const std::string between = amplitudes_over_torque(frame, points, std::nullopt, "").csv();
  EXPECT_NE(between.find("\n0,50,0.705625000,"), std::string::npos)
      << between.substr(0, 300); // 0.25 + 67.5^2/1e4
  EXPECT_NE(between.find(",1.411250000,1\n"), std::string::npos);
  EXPECT_NE(between.find("\n0,117.5,0.250000000,"), std::string::npos);
  EXPECT_EQ(std::count(between.begin(), between.end(), '\n'), 2 + 3 + 399); // two lines above them
  // 0.3 is computed, and a place between 0.2 and 0.6 but for its last bit.
  frame.loads = { 0.2, 0.3, 0.6 };
  const std::string rounded =
      amplitudes_over_torque(frame, parabola(frame, 0.4, 0.25), std::nullopt, "").csv();
  EXPECT_EQ(std::count(rounded.begin(), rounded.end(), '\n'), 2 + 3 + 398) << rounded.substr(0, 300);
  // Torques of a billionth: the least is found as well, in proportion.
  frame.loads = { 100e-9, 50e-9, 200e-9 };
  const std::string light =
      design_torques(frame, parabola(frame, 117.5e-9, 0.25, 1e-9), std::nullopt, "").csv();
  ASSERT_EQ(std::sscanf(light.substr(light.find("0,A1")).c_str(), "0,A1,%lf", &a1), 1) << light;
  EXPECT_NEAR(a1, 117.5e-9, 1e-17);
  frame.loads = { 100, 50, 200 };
  frame.period = 0; // not whole periods: no harmonics
  EXPECT_EQ(design_torques(frame, points, std::nullopt, "").csv().find("0,A1"), std::string::npos);
  // Nothing lies between an unloaded and one loaded torque.
  EXPECT_TRUE(has_design_torques(frame));
  frame.loads = { 0, 100 };
  EXPECT_FALSE(has_design_torques(frame));
  EXPECT_EQ(design_torque_line(frame, points), "");
  frame.period = 8;
  EXPECT_TRUE(amplitudes_over_torque(frame, points, std::nullopt, "").empty());
}

namespace
{
  /// TE = T/10 + size A(T) cos(2 pi phase), A a parabola down to 1 at 20 N m, 1 up to 40 N m, and up again;
  /// all with rounding noise of so many um.
  std::vector<StudyPoint> plateau(const VariantFrame &frame, const double size, const double noise)
  {
    std::vector<StudyPoint> points;
    for (const double phase : frame.abscissa)
      for (const double torque : frame.loads)
        {
          StudyPoint point{};
          const double c = size * std::cos(2 * units::pi * phase),
                       d = torque < 20 ? torque - 20 : std::max(0.0, torque - 40);
          point.response = 0.1 * torque + (1 + 1e-3 * d * d) * c + noise * std::sin(37 * phase + 11 * torque);
          point.response_slope = 0.1 + 2e-3 * d * c;
          points.push_back(point);
        }
    return points;
  }
} // namespace

TEST(DesignTorques, PlateauIsNone)
{
  VariantFrame frame;
  frame.loads = { 10, 20, 25, 30, 40, 50 };
  for (int k = 0; k < 8; ++k)
    frame.abscissa.push_back(k / 8.0);
  frame.period = 8;
  for (const auto &[size, noise] : { std::pair{ 1.0, 0.0 }, { 1.0, 1e-12 }, { 1.0, 3e-11 }, { 0.0, 1e-14 } })
    {
      const std::vector<StudyPoint> points = plateau(frame, size, noise);
      EXPECT_EQ(design_torque_line(frame, points),
                "design torques, of least A1: none; of least peak-to-peak: none\n")
          << size << " um with noise of " << noise << " um";
    }
  // A minimum half-way between two places that are looked at, which are equally high, is one.
  frame.loads = { 50, 100, 200 };
  for (const double at : { 100 + 100 * 2.5 / 12, 100 + 100 * 3 / 12.0 })
    {
      const std::vector<StudyPoint> valley = parabola(frame, at, 0.25);
      const TransmissionErrorCurve curve(frame, valley);
      ASSERT_EQ(curve.torques_of_least_amplitude().size(), 1u) << at;
      EXPECT_NEAR(curve.torques_of_least_amplitude()[0].torque, at, 1e-9);
      ASSERT_EQ(curve.torques_of_least_peak_to_peak().size(), 1u) << at;
      EXPECT_NEAR(curve.torques_of_least_peak_to_peak()[0].torque, at, 1e-9);
    }
}

namespace
{
  /// TE = T/10 + A(T) cos(2 pi phase), its slope by a difference.
  std::vector<StudyPoint> wave(const VariantFrame &frame, const std::function<double(double)> &amplitude)
  {
    std::vector<StudyPoint> points;
    for (const double phase : frame.abscissa)
      for (const double torque : frame.loads)
        {
          const auto te = [&](const double t) {
            return 0.1 * t + amplitude(t) * std::cos(2 * units::pi * phase);
          };
          StudyPoint point{};
          point.response = te(torque);
          point.response_slope = (te(torque + 1e-5) - te(torque - 1e-5)) / 2e-5;
          points.push_back(point);
        }
    return points;
  }

  double amplitude_of(const std::vector<double> &te)
  {
    return harmonic_amplitude(te, 1);
  }
} // namespace

TEST(BoundsOverTorque, HoldBetweenComputedTorques)
{
  VariantFrame frame;
  frame.loads = { 200, 50, 100, 300 };
  for (int k = 0; k < 8; ++k)
    frame.abscissa.push_back(k / 8.0);
  frame.period = 8;
  const std::map<double, double> stated = { { 50, 0.01 }, { 100, 0.02 }, { 200, 0.03 }, { 300, 0.01 } };
  // Cubics of cubics are exact: nothing is left but what is stated, the greater of both sides.
  const std::vector<StudyPoint> smooth = parabola(frame, 120, 0.25, 1, 3e-7);
  const BoundsOverTorque exact(TransmissionErrorCurve(frame, smooth), stated, amplitude_of);
  for (const auto &[torque, bound] : { std::pair{ 50.0, 0.01 },
                                       { 75.0, 0.02 },
                                       { 100.0, 0.02 },
                                       { 150.0, 0.03 },
                                       { 290.0, 0.03 },
                                       { 300.0, 0.01 } })
    EXPECT_NEAR(exact.at(torque), bound, 1e-8) << torque;
  EXPECT_TRUE(std::isnan(exact.at(40)) && std::isnan(exact.at(301)));
  // Of a curve that bends fast where torques are low, and of one with a kink, what the interpolation misses
  // is in it; at computed torques nothing is added.
  for (const auto &amplitude : { std::function([](const double t) { return 40 / (t + 20); }),
                                 std::function([](const double t) { return 0.01 * std::abs(t - 107); }) })
    {
      const std::vector<StudyPoint> points = wave(frame, amplitude);
      const TransmissionErrorCurve curve(frame, points);
      const BoundsOverTorque bounds(curve, stated, amplitude_of);
      double most = 0;
      for (int k = 0; k <= 250; ++k)
        {
          const double torque = 50 + k, wrong = std::abs(curve.amplitude(torque, 1) - amplitude(torque)),
                       added = bounds.at(torque) - exact.at(torque);
          EXPECT_GE(added, wrong - 1e-7) << torque;
          most = std::max(most, wrong);
        }
      EXPECT_GT(most, 0.002); // there is something to bound
      EXPECT_EQ(bounds.at(100), 0.02);
    }
  // Nothing is known where none of the torques lies between two others, or nothing is stated on a side.
  const std::map<double, double> without_100 = { { 50, 0.01 }, { 100, NAN }, { 200, 0.03 }, { 300, 0.01 } };
  const BoundsOverTorque part(TransmissionErrorCurve(frame, smooth), without_100, amplitude_of);
  EXPECT_TRUE(std::isnan(part.at(75)) && std::isnan(part.at(100)) && std::isnan(part.at(150)));
  EXPECT_NEAR(part.at(250), 0.03, 1e-8);
  frame.loads = { 50, 300 };
  const std::vector<StudyPoint> two = parabola(frame, 120, 0.25);
  const BoundsOverTorque of_two(TransmissionErrorCurve(frame, two), { { 50, 0.01 }, { 300, 0.02 } },
                                amplitude_of);
  EXPECT_EQ(of_two.at(50), 0.01);
  EXPECT_TRUE(std::isnan(of_two.at(100)));
}

namespace
{
  /// Two torques of a band that share two kept cells, and a third without.
  std::vector<PositionResult> band_with_cells()
  {
    std::vector<ContactCell> cells(2);
    double next = 0.5;
    const auto number = [&] { return next += 0.25; };
    for (ContactCell &cell : cells)
      {
        cell.slice = static_cast<int>(4 * number());
        for (Patch *patch : { &cell.pinion, &cell.gear })
          {
            patch->tooth = static_cast<int>(4 * number());
            patch->roll = number(), patch->z = number();
            patch->half_profile = number(), patch->half_generator = number();
            for (int corner = 0; corner < 3; ++corner)
              patch->outline.push_back({ number(), number() });
          }
        cell.area = number(), cell.gap = number(), cell.lever = number();
        cell.tilt = { number(), number(), number(), number() };
      }
    cells[1].window_border = true;
    cells[0].cut_short = true;
    cells[1].place = CellPlace::corner;
    const auto kept = std::make_shared<const std::vector<ContactCell>>(cells);
    std::vector<PositionResult> band(3);
    for (int t = 0; t < 3; ++t)
      {
        band[t].torque = 1000.0 * (t + 1);
        band[t].phase = 0.25;
        band[t].certificate = {};
        if (t < 2)
          {
            band[t].contact_cells = kept;
            band[t].contact_force = Eigen::Vector2d(number(), 0);
            band[t].contact_gap = Eigen::Vector2d(0, number());
          }
      }
    return band;
  }

  std::vector<char> packed(const std::vector<PositionResult> &band)
  {
    Packer out;
    pack(band, out);
    return out.result;
  }
} // namespace

TEST(PositionRecord, KeepsContactCellsToTheLastBit)
{
  const std::vector<PositionResult> band = band_with_cells();
  const std::vector<char> bytes = packed(band);
  Unpacker in(bytes);
  const std::vector<PositionResult> read = unpack_band(in);
  EXPECT_TRUE(in.at_end());
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0].contact_cells, read[1].contact_cells); // once for all torques of a grid
  EXPECT_EQ(read[2].contact_cells, nullptr);
  for (int t = 0; t < 2; ++t)
    {
      EXPECT_EQ(read[t].contact_force, band[t].contact_force);
      EXPECT_EQ(read[t].contact_gap, band[t].contact_gap);
    }
  for (std::size_t i = 0; i < 2; ++i)
    {
      const ContactCell &a = (*read[0].contact_cells)[i], &b = (*band[0].contact_cells)[i];
      EXPECT_EQ(a.slice, b.slice);
      EXPECT_EQ(a.area, b.area);
      EXPECT_EQ(a.gap, b.gap);
      EXPECT_EQ(a.lever, b.lever);
      EXPECT_EQ(a.window_border, b.window_border);
      EXPECT_EQ(a.cut_short, b.cut_short);
      EXPECT_EQ(a.place, b.place);
      EXPECT_EQ(a.tilt, b.tilt);
      for (const auto patch : { &ContactCell::pinion, &ContactCell::gear })
        {
          EXPECT_EQ((a.*patch).tooth, (b.*patch).tooth);
          EXPECT_EQ((a.*patch).outline, (b.*patch).outline);
          EXPECT_EQ((a.*patch).roll, (b.*patch).roll);
          EXPECT_EQ((a.*patch).z, (b.*patch).z);
          EXPECT_EQ((a.*patch).half_profile, (b.*patch).half_profile);
          EXPECT_EQ((a.*patch).half_generator, (b.*patch).half_generator);
        }
    }
}

TEST(PositionRecord, TakesNoCellsThatCannotBe)
{
  const std::vector<double> torques = { 1000, 2000, 3000 };
  const auto holds = [&](const std::vector<PositionResult> &band) {
    return is_band(packed(band), torques, 0.25, 1);
  };
  EXPECT_TRUE(holds(band_with_cells()));
  std::vector<PositionResult> band = band_with_cells();
  band[1].contact_force = Eigen::Vector3d::Ones(); // not one a cell
  EXPECT_FALSE(holds(band));
  band = band_with_cells();
  band[0].contact_gap[1] = std::nan("");
  EXPECT_FALSE(holds(band));
  for (const auto &[value, sense] :
       { std::pair(std::numeric_limits<double>::infinity(), true), { std::nan(""), false }, { -1.0, false } })
    {
      band = band_with_cells();
      band[1].condition = value; // cells that coincide have an infinite one
      EXPECT_EQ(holds(band), sense) << value;
    }
  for (const auto spoil :
       { +[](ContactCell &cell) { cell.place = static_cast<CellPlace>(9); },
         +[](ContactCell &cell) { cell.area = 0; }, +[](ContactCell &cell) { cell.tilt[2] = std::nan(""); },
         +[](ContactCell &cell) { cell.gear.outline[1].x() = 1 / 0.0; } })
    {
      band = band_with_cells();
      std::vector<ContactCell> cells = *band[0].contact_cells;
      spoil(cells[1]);
      band[0].contact_cells = band[1].contact_cells = std::make_shared<const std::vector<ContactCell>>(cells);
      EXPECT_FALSE(holds(band));
    }
  std::vector<char> bytes = packed(band_with_cells());
  bytes.resize(bytes.size() / 2);
  EXPECT_FALSE(is_band(bytes, torques, 0.25, 1));
}
