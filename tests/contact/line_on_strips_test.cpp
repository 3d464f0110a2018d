// SPDX-License-Identifier: GPL-2.0-or-later
// Hertz's line contact told from strips of uniform pressure, which solve it worse than by a tenth of a
// percent.
#include "contact/half_space/hertz.hpp"
#include "contact/half_space/line_on_strips.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/small_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace flank;
using half_space::LoadedStrip;

namespace
{
  constexpr double modulus = 113.7e3, radius = 7.3, load = 240; // [MPa], [mm], [N/mm]

  /// Mean over strip i of what a unit line load on strip j deflects: strips of equal width w, by quadrature
  /// over i of the integral of -2/(pi E*) ln |x - s| over j, whose antiderivative is x ln|x| - x. [mm mm/N]
  double influence(const int apart, const double w)
  {
    const auto antiderivative = [](const double x) { return x == 0 ? 0 : x * std::log(std::abs(x)) - x; };
    constexpr int n = 400; // midpoints, crowded where the logarithm bends: error below 1e-7 of the greatest
    double sum = 0, weights = 0;
    for (int k = 0; k < n; ++k)
      {
        const double t = (k + 0.5) / n, x = w * (0.5 - 0.5 * std::cos(units::pi * t)) + apart * w,
                     weight = std::sin(units::pi * t);
        sum += weight * (antiderivative(x) - antiderivative(x - w)) / w;
        weights += weight;
      }
    return -2 / (units::pi * modulus) * sum / weights;
  }

  struct Solved
  {
    double approach;
    std::vector<LoadedStrip> strips; ///< the loaded ones
    double max_pressure;             ///< of the strips
  };

  /// Strips of a window about `middle` pressed together.
  Solved press(const int n, const double half_window, const double middle,
               const std::function<double(double)> &gap)
  {
    const double w = 2 * half_window / n;
    ContactProblem problem;
    problem.compliance.resize(n, n);
    problem.gap.resize(n);
    problem.lever = Eigen::VectorXd::Ones(n);
    std::vector<double> by_distance;
    for (int k = 0; k < n; ++k)
      by_distance.push_back(influence(k, w));
    const auto place = [&](const int i) { return middle + (i - (n - 1) / 2.0) * w; };
    for (int i = 0; i < n; ++i)
      {
        problem.gap[i] = 0;
        constexpr int points = 200;
        for (int k = 0; k < points; ++k)
          problem.gap[i] += gap(place(i) + w * ((k + 0.5) / points - 0.5)) / points;
        for (int j = 0; j < n; ++j)
          problem.compliance(i, j) = by_distance[static_cast<std::size_t>(std::abs(i - j))];
      }
    const ContactSolution solution = SimplexSolver(problem).solve(load);
    EXPECT_EQ(solution.status, Status::solved);
    Solved result{ .approach = solution.theta, .strips = {}, .max_pressure = solution.force.maxCoeff() / w };
    for (int i = 0; i < n; ++i)
      if (solution.force[i] > 0)
        result.strips.push_back({ place(i), w / 2, solution.force[i] });
    return result;
  }

  double parabola(const double x)
  {
    return x * x / (2 * radius);
  }
} // namespace

TEST(LineOnStrips, ApproachAndPressureAreHertzsHoweverTheStripsFall)
{
  const auto [half_width, pressure] = half_space::hertz_line(radius, modulus, load);
  // Johnson (1985), 4.2(c): the middle of the contact, from the origin of the logarithm in mm.
  const double approach = load / (units::pi * modulus) * (2 * std::log(2 / half_width) + 1);
  double worst_on_strips = 0, worst_pressure = 0;
  for (const int n : { 5, 9, 11, 21 })
    for (const double ratio : { 1.15, 1.4, 1.6 })
      for (const double shift : { -0.4, 0.0, 0.17, 0.5 }) // strips
        {
          const double window = ratio * half_width;
          const Solved solved = press(n, window, shift * 2 * window / n, parabola);
          const auto line = half_space::line_on_strips(solved.strips, modulus);
          ASSERT_TRUE(line) << n << " " << ratio << " " << shift;
          EXPECT_EQ(line->certainty, 1) << n << " " << ratio << " " << shift;
          // The quadratures of this test, 1e-5 of the gap at the contact's ends.
          EXPECT_NEAR(solved.approach - line->excess_approach, approach, 2e-6 * approach);
          EXPECT_NEAR(line->max_pressure, pressure, 1e-4 * pressure);
          worst_on_strips = std::max(worst_on_strips, std::abs(solved.approach / approach - 1));
          worst_pressure = std::max(worst_pressure, std::abs(solved.max_pressure / pressure - 1));
        }
  EXPECT_GT(worst_on_strips, 3e-4); // what the strips themselves are wrong by
  EXPECT_GT(worst_pressure, 5e-3);
}

TEST(LineOnStrips, IsSilentWhereTheContactIsNotHertzs)
{
  const double b = half_space::hertz_half_width(radius, modulus, load);
  // A kink of a third of the slope at the contact's end, where relief begins within it.
  const Solved kink = press(11, 1.5 * b, 0, [&](const double x) {
    return parabola(x) + (x > 0.2 * b ? 0.33 * b / radius * (x - 0.2 * b) : 0.0);
  });
  EXPECT_FALSE(half_space::line_on_strips(kink.strips, modulus));
  // Strips that end where a flank does, with the contact half as wide on that side as it would be.
  const Solved edge = press(11, 0.75 * b, -0.25 * b, parabola);
  ASSERT_EQ(edge.strips.size(), 11U);
  EXPECT_FALSE(half_space::line_on_strips(edge.strips, modulus));
  EXPECT_FALSE(half_space::line_on_strips({}, modulus));
  const Solved few = press(4, 1.1 * b, 0, parabola);
  EXPECT_FALSE(half_space::line_on_strips({ few.strips.begin(), few.strips.begin() + 2 }, modulus));
}

TEST(LineOnStrips, DoesNotStepWhereAStripComesToCarry)
{
  // A kink crosses the contact in steps of 0.008 half-widths; strips begin and cease to be loaded.
  const double b = half_space::hertz_half_width(radius, modulus, load);
  int changes = 0;
  for (const int n : { 11, 15 })
    for (const double kink : { 0.1, 0.25 })
      {
        double before = 0, greatest = 0;
        std::size_t loaded = 0;
        for (int k = 0; k <= 300; ++k)
          {
            const double at = (1.2 - 0.008 * k) * b;
            const Solved solved = press(n, 1.5 * b, 0.1 * b, [&](const double x) {
              return parabola(x) + kink * b / radius * std::max(0.0, x - at);
            });
            const auto line = half_space::line_on_strips(solved.strips, modulus);
            const double approach = solved.approach - (line ? line->excess_approach : 0);
            if (k > 0)
              greatest = std::max(greatest, std::abs(approach - before) / approach);
            changes += k > 0 && solved.strips.size() != loaded;
            loaded = solved.strips.size();
            before = approach;
          }
        // What the kink's way changes; weighed alike, strips that just touched made steps of 0.002 and more.
        EXPECT_LT(greatest, 1.2e-3) << n << " strips, kink " << kink;
      }
  EXPECT_GE(changes, 2);
}

TEST(LineOnStrips, TransmissionErrorDoesNotStepWhereGridsDo)
{
  // Torques of neighbouring octaves have windows of another width, and their cells leave other errors.
  const GearPair pair = make_gear_pair(paper_pair(0));
  LoadedPair mesh = small_loaded_pair(pair, small_body(0), small_body(0));
  double greatest = 0;
  int other_grids = 0;
  for (const double phase : { 0.3, 0.45 }) // the same tooth pairs at all torques
    {
      std::vector<double> torques;
      for (int k = 0; k <= 36; ++k) // three octaves
        torques.push_back(40e3 * std::exp2(k / 12.0));
      const std::vector<PositionResult> all = mesh.solve(phase, torques);
      // Rotation over torque bends smoothly; third differences of it are steps.
      for (std::size_t k = 0; k + 3 < all.size(); ++k)
        {
          const auto at = [&](const std::size_t i) { return all[k + i].theta / all[k + i].torque; };
          greatest = std::max(greatest, std::abs(at(0) - 3 * at(1) + 3 * at(2) - at(3)) / at(0));
          other_grids += all[k].grid_cells != all[k + 1].grid_cells;
        }
    }
  EXPECT_GE(other_grids, 4);
  // On cells alone 4e-4.
  EXPECT_LT(greatest, 8e-5);
}
