// SPDX-License-Identifier: GPL-2.0-or-later
// Bounds of what positions miss of a transmission error, on curves that are known everywhere.
#include "cases/parallel_axis/pair/error_bounds.hpp"
#include "cases/results/harmonics.hpp"
#include "mesh/base/units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

using namespace flank;

namespace
{
  std::vector<double> sampled(const std::function<double(double)> &curve, const int positions,
                              const double begin)
  {
    std::vector<double> te;
    for (int k = 0; k < positions; ++k)
      te.push_back(20 + curve(std::fmod(begin + static_cast<double>(k) / positions, 1.0)));
    return te;
  }

  double mean_of(const std::vector<double> &te)
  {
    return std::accumulate(te.begin(), te.end(), 0.0) / static_cast<double>(te.size());
  }
} // namespace

TEST(ErrorBounds, HoldAtFewPositionsToo)
{
  // A step to fewer tooth pairs and back, a curve with a kink, a smooth one; grids and bodies without errors.
  const std::vector<std::function<double(double)>> curves = {
    [](const double t) { return std::clamp((0.3 - std::abs(t - 0.5)) / 0.12 + 0.5, 0.0, 1.0); },
    [](const double t) { return t < 0.3 ? t / 0.3 : (1 - t) / 0.7; },
    [](const double t) { return 4 * t * (1 - t); }
  };
  const CoarserDifferences exact{ .by_grid = { 0, 0 }, .by_bodies = { 0, 0 }, .between = {} };
  for (std::size_t c = 0; c < curves.size(); ++c)
    {
      const std::vector<double> fine = sampled(curves[c], 1024, 0);
      const std::vector<double> three = sampled(curves[c], 3, 0);
      EXPECT_TRUE(std::isnan(error_bounds(three, harmonics(three), 1, exact).mean));
      for (int n = 4; n < 16; ++n)
        for (int part = 0; part < 8; ++part)
          {
            const std::vector<double> te = sampled(curves[c], n, part / 8.0 / n);
            const TransmissionErrorBounds bounds = error_bounds(te, harmonics(te), 1, exact);
            EXPECT_LE(std::abs(mean_of(te) - mean_of(fine)), bounds.mean) << c << " " << n << " " << part;
            CoarserDifferences beside = exact; // with what a run computes halfway beside the peaks
            const auto [least, greatest] = std::ranges::minmax_element(te);
            for (const auto peak : { least, greatest })
              for (const double place : { peak - te.begin() + 0.5, peak - te.begin() - 0.5 + n })
                beside.between[std::fmod(place, n)] = 20 + curves[c](std::fmod((place + part / 8.0) / n, 1));
            EXPECT_LE(1 - (*greatest - *least), error_bounds(te, harmonics(te), 1, beside).peak_to_peak)
                << c << " " << n << " " << part;
            for (int i = 1; i <= 3; ++i)
              if (2 * i > n)
                {
                  EXPECT_TRUE(std::isnan(bounds.amplitude[i - 1])) << n << " " << i;
                  EXPECT_TRUE(std::isnan(harmonic_amplitude(te, i))) << n << " " << i;
                }
              else
                EXPECT_LE(std::abs(harmonic_amplitude(te, i) - harmonic_amplitude(fine, i)),
                          bounds.amplitude[i - 1])
                    << c << " " << n << " " << part << " A" << i;
          }
    }
}

TEST(ErrorBounds, ContainWhatThePlacesOfJumpsMake)
{
  // Tooth pairs that take their load at once and leave it so: of all durations and places, the bounds contain
  // more than four fifths of the errors (57 to 74 % where jumps do not count); two cycles say the same. What
  // is known halfway in their steps makes that more than nine tenths, by bounds not much wider.
  const CoarserDifferences exact{ .by_grid = { 0, 0 }, .by_bodies = { 0, 0 }, .between = {} };
  constexpr int n = 16, durations = 20, places = 16;
  std::array<int, 4> contained{}, contained_by_halves{};
  std::array<double, 4> width{}, width_by_halves{};
  for (int i = 0; i < durations; ++i)
    for (int k = 0; k < places; ++k)
      {
        const double duration = 0.2 + 0.4 * i / durations, shift = (k + 0.01) / places / n;
        const auto curve = [&](const double t) {
          return (t < duration ? 1 : 0) + 0.1 * std::cos(2 * units::pi * t);
        };
        const std::vector<double> fine = sampled(curve, 4096, 0), te = sampled(curve, n, shift);
        std::vector<double> twice = te;
        twice.insert(twice.end(), te.begin(), te.end());
        const TransmissionErrorBounds bounds = error_bounds(te, harmonics(te), 1, exact),
                                      of_two = error_bounds(twice, harmonics(twice), 2, exact);
        // What lies halfway in the steps of both jumps is known, as a run has it.
        CoarserDifferences halves = exact;
        for (const int step : steps_of_jumps(te))
          halves.between[step + 0.5] = 20 + curve(std::fmod((step + 0.5) / n + shift, 1));
        EXPECT_EQ(halves.between.size(), 2u);
        const TransmissionErrorBounds by_halves = error_bounds(te, harmonics(te), 1, halves);
        contained[0] += std::abs(mean_of(te) - mean_of(fine)) <= bounds.mean;
        EXPECT_NEAR(of_two.mean, bounds.mean, 1e-9);
        for (int h = 1; h <= 3; ++h)
          {
            contained[h] +=
                std::abs(harmonic_amplitude(te, h) - harmonic_amplitude(fine, h)) <= bounds.amplitude[h - 1];
            EXPECT_NEAR(of_two.amplitude[h - 1], bounds.amplitude[h - 1], 1e-9) << h;
            contained_by_halves[h] += std::abs(harmonic_amplitude(te, h) - harmonic_amplitude(fine, h)) <=
                                      by_halves.amplitude[h - 1];
            width[h] += bounds.amplitude[h - 1], width_by_halves[h] += by_halves.amplitude[h - 1];
          }
      }
  for (const int of : contained)
    EXPECT_GT(of, 0.8 * durations * places) << of;
  for (int h = 1; h <= 3; ++h)
    {
      EXPECT_GT(contained_by_halves[h], std::max<double>(contained[h], 0.9 * durations * places)) << h;
      EXPECT_LT(width_by_halves[h], 1.2 * width[h]) << h;
    }
}

TEST(ErrorBounds, SeeAContactOfOnePairThatIsShorterThanAStep)
{
  // Nearly two tooth pairs at all times: 1 to 4 % of a mesh cycle with one alone, half as much again of
  // deflection.
  const auto curve = [](const double t) {
    const double from_middle = std::abs(t - std::floor(t) - 0.5);
    return 1 - 0.2 * std::cos(2 * units::pi * t) + 0.5 * std::clamp((0.02 - from_middle) / 0.015, 0.0, 1.0);
  };
  const std::vector<double> fine = sampled(curve, 1024, 0);
  constexpr int n = 16;
  for (int part = 0; part < 16; ++part)
    {
      const double shift = part / 16.0 / n;
      const std::vector<double> te = sampled(curve, n, shift);
      CoarserDifferences coarser{ .by_grid = { 0, 0 }, .by_bodies = { 0, 0 }, .between = {} };
      const auto [least, greatest] = std::minmax_element(te.begin(), te.end());
      for (const auto peak : { least, greatest })
        for (const double half : { -0.5, 0.5 })
          {
            const double place = std::fmod(static_cast<double>(peak - te.begin()) + half + n, n);
            coarser.between[place] = 20 + curve(place / n + shift);
          }
      const TransmissionErrorBounds bounds = error_bounds(te, harmonics(te), 1, coarser);
      // Where the point halfway falls on its flank, a bit less than all of it.
      constexpr double seen = 0.85;
      EXPECT_LE(seen * std::abs(mean_of(te) - mean_of(fine)), bounds.mean) << part;
      EXPECT_LE(bounds.mean, 0.07) << part;
      for (int i = 1; i <= 3; ++i)
        EXPECT_LE(seen * std::abs(harmonic_amplitude(te, i) - harmonic_amplitude(fine, i)),
                  bounds.amplitude[i - 1])
            << part << " A" << i;
    }
}
