// SPDX-License-Identifier: GPL-2.0-or-later
// Exact derivatives by the parameters of flank modifications, against central differences of whole solutions.
#include "cases/parallel_axis/input/input.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/scenes.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/small_mesh.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace flank;

namespace
{
  CaseFile modified_case()
  {
    return CaseFile::read(schema(), std::string(FLANK_ROOT) + "/cases/parallel_axis/helical.toml",
                          { "output.derivatives=yes", "pinion.tip_relief.shape=quadratic",
                            "pinion.root_relief.amount_um=3", "pinion.root_relief.start_diameter_mm=146.5",
                            "pinion.profile_slope.amount_um=1.5", "pinion.profile_crown.amount_um=2",
                            "pinion.helix_slope.amount_um=2.5", "gear.helix_slope.amount_um=1",
                            "pinion.end_relief.amount_um=4", "pinion.end_relief.length_mm=5",
                            "gear.tip_relief.amount_um=6", "gear.tip_relief.start_length_of_roll_mm=29",
                            "pinion.bias=[{corner=1, amount_um=5, start_roll_angle_deg=16, length_mm=15, "
                            "shape=\"quadratic\"}]" });
  }

  struct At
  {
    std::vector<std::string> keys;
    std::vector<std::vector<double>> by; ///< [torque][key] [rad over the key's unit]
    std::vector<double> theta;
  };

  At solve(const CaseFile &file, const double phase)
  {
    const ParallelAxisCase input = read_pair(file);
    LoadedPair mesh = small_loaded_pair(input.pair, small_body(25.232), small_body(25.232), input.deviations);
    mesh.derivatives = true;
    At result{ .keys = input.parameters, .by = {}, .theta = {} };
    auto positions = mesh.solve(phase, { 250e3, 150e3 });
    positions.push_back(mesh.unloaded(phase));
    for (const PositionResult &position : positions)
      {
        result.by.push_back(position.theta_by_parameter);
        result.theta.push_back(position.theta);
      }
    return result;
  }
} // namespace

TEST(Derivatives, AgreeWithCentralDifferencesForEveryParameter)
{
  const CaseFile file = modified_case();
  std::set<std::string> that_matter;
  for (const double phase : { 0.2, 0.65 })
    {
      const At here = solve(file, phase);
      EXPECT_EQ(here.keys.size(),
                16u); // amounts, starts and lengths of all of the above, once each where [gear] copies
      for (std::size_t k = 0; k < here.keys.size(); ++k)
        {
          const double value = file.number(here.keys[k]),
                       step = 1e-7 * std::abs(value); // few cells change their state
          const auto moved = [&](const double to) {
            return solve(file.with({ fmt::format("{}={:.17g}", here.keys[k], to) }, "test"), phase);
          };
          const At high = moved(value + step), low = moved(value - step);
          for (std::size_t t = 0; t < here.theta.size(); ++t)
            {
              if (here.by[t][k] != 0)
                that_matter.insert(here.keys[k]);
              const double difference = (high.theta[t] - low.theta[t]) / (2 * step);
              // 1e-5, and the rounding of theta (1e-15 of some 1e-4 rad) over the step. Unloaded the touch is
              // a searched minimum: Brent's 20 bits leave 1e-12 mm in it.
              const double rounding = (t == 2 ? 1e-14 : 1e-18) / step;
              EXPECT_NEAR(here.by[t][k], difference, 1e-5 * std::abs(difference) + rounding)
                  << here.keys[k] << " at phase " << phase << ", torque " << t;
            }
        }
    }
  EXPECT_EQ(that_matter.size(), 16u);
}

TEST(Derivatives, OfAnAmplitude)
{
  std::vector<double> values, slopes, moved;
  for (int k = 0; k < 12; ++k)
    {
      values.push_back(std::cos(0.7 * k) + 0.1 * k);
      slopes.push_back(std::sin(1.3 * k * k));
    }
  for (const int harmonic : { 1, 3, 6 })
    {
      const auto amplitude = [&](const double step) {
        std::vector<double> at = values;
        for (std::size_t k = 0; k < at.size(); ++k)
          at[k] += step * slopes[k];
        return harmonics(at)[harmonic - 1].amplitude;
      };
      EXPECT_NEAR(amplitude_derivative(values, slopes, harmonic), (amplitude(1e-5) - amplitude(-1e-5)) / 2e-5,
                  1e-9);
    }
}

TEST(Derivatives, ParametersAsNumbersAreTheCaseWithThem)
{
  // All at once, those that [gear] copies and mirrors too: the same bits as the case that says so in text, on
  // the first pair's compliance.
  const CaseFile file = modified_case();
  const ParallelAxisCase input = read_pair(file);
  std::vector<double> values;
  std::vector<std::string> settings;
  for (const std::string &key : input.parameters)
    {
      values.push_back(file.number(key) * (1 + 1e-3 * static_cast<double>(values.size() + 1)));
      settings.push_back(fmt::format("{}={:.17g}", key, values.back()));
    }
  EXPECT_EQ(input.deviations.values().size(), input.parameters.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    EXPECT_EQ(input.deviations.values()[k], file.number(input.parameters[k]));
  const At in_text = solve(file.with(settings, "test"), 0.2);
  LoadedPair mesh = small_loaded_pair(input.pair, small_body(25.232), small_body(25.232), input.deviations);
  mesh.derivatives = true;
  PositionCompliance compliance = mesh.compliance();
  const std::vector<double> torques = { 250e3, 150e3, 0 };
  const auto before = mesh.solve_all(mesh.at(0.2), torques, { 0 }, compliance).front();
  const LoadedPair moved = mesh.with(values);
  EXPECT_EQ(moved.deviations.values(), values);
  const auto in_numbers = moved.solve_all(moved.at(0.2), torques, { 0 }, compliance).front();
  for (std::size_t t = 0; t < torques.size(); ++t)
    {
      EXPECT_NE(before[t].theta, in_numbers[t].theta);
      EXPECT_EQ(in_text.theta[t], in_numbers[t].theta);
      EXPECT_EQ(in_text.by[t], in_numbers[t].theta_by_parameter);
    }
  const LoadedPair back = moved.with(input.deviations.values());
  EXPECT_EQ(back.solve_all(back.at(0.2), torques, { 0 }, compliance).front()[0].theta, before[0].theta);
}
