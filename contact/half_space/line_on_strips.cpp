// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/line_on_strips.hpp"

#include "contact/half_space/hertz.hpp"
#include "mesh/base/units.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace flank::half_space
{
  namespace
  {
    using units::pi;

    /// Its second derivative is ln |x|.
    double twice_integrated_logarithm(const double x)
    {
      return x == 0 ? 0 : x * x / 2 * std::log(std::abs(x)) - 0.75 * x * x;
    }

    /// Mean of ln |x - s|, x on one strip and s on the other.
    double mean_logarithm(const LoadedStrip &a, const LoadedStrip &b)
    {
      const double d = a.place - b.place, sum = a.half_width + b.half_width,
                   difference = a.half_width - b.half_width;
      const auto &g = twice_integrated_logarithm;
      return (g(d + sum) - g(d + difference) - g(d - difference) + g(d - sum)) /
             (4 * a.half_width * b.half_width);
    }

    /// Mean deflections of the strips by unit line loads on each, from an origin that is the same for all
    /// loads in mm. [mm mm/N]
    Eigen::MatrixXd influence(const std::vector<LoadedStrip> &strips, const double effective_modulus)
    {
      const auto n = static_cast<Eigen::Index>(strips.size());
      Eigen::MatrixXd result(n, n);
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j)
          result(i, j) = result(j, i) =
              -2 / (pi * effective_modulus) *
              mean_logarithm(strips[static_cast<std::size_t>(i)], strips[static_cast<std::size_t>(j)]);
      return result;
    }

    /// A quantity and its derivatives by the strips' loads.
    struct Derived
    {
      double value;
      Eigen::RowVectorXd by_load;
    };

    /// 1 at values up to `sure`, 0 from `none` on, between them without a corner.
    Derived certainty(const Derived &distance, const double sure, const double none)
    {
      const double t = std::clamp((none - distance.value) / (none - sure), 0.0, 1.0);
      return { t * t * (3 - 2 * t), distance.by_load * (6 * t * (t - 1) / (none - sure)) };
    }
  } // namespace

  std::optional<LineOnStrips> line_on_strips(const std::vector<LoadedStrip> &strips,
                                             const double effective_modulus)
  {
    // A parabola goes through any three strips; where the contact ends then tells alone whether it is one.
    constexpr std::size_t fewest = 3;
    if (strips.size() < fewest)
      return std::nullopt;
    const auto n = static_cast<Eigen::Index>(strips.size());
    Eigen::VectorXd load(n);
    double low = strips.front().place, high = low;
    for (Eigen::Index i = 0; i < n; ++i)
      {
        const LoadedStrip &strip = strips[static_cast<std::size_t>(i)];
        load[i] = strip.load_per_length;
        low = std::min(low, strip.place - strip.half_width);
        high = std::max(high, strip.place + strip.half_width);
      }
    const double origin = (low + high) / 2, unit = (high - low) / 2, total = load.sum(),
                 flexibility = total / (pi * effective_modulus); // [mm]

    // Means of 1, t and t^2 over the strips; t runs from -1 to 1.
    Eigen::MatrixXd means(n, 3);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        const LoadedStrip &strip = strips[static_cast<std::size_t>(i)];
        const double t = (strip.place - origin) / unit, half = strip.half_width / unit;
        means.row(i) << 1, t, t * t + half * half / 3;
      }
    // Least squares weighted by the loads: a strip that has just touched changes nothing.
    const Eigen::MatrixXd by_load = influence(strips, effective_modulus),
                          weighted = load.asDiagonal() * means;
    const Eigen::VectorXd deflected = by_load * load;
    const auto normal = (means.transpose() * weighted).eval().ldlt();
    const Eigen::Vector3d parabola = normal.solve(weighted.transpose() * deflected);
    const Eigen::VectorXd misfit = deflected - means * parabola;
    const Eigen::MatrixXd fit = normal.solve(weighted.transpose() * by_load +
                                             means.transpose() * Eigen::MatrixXd(misfit.asDiagonal()));
    if (!(parabola[2] < 0))
      return std::nullopt;
    const double bend = parabola[2], slope = parabola[1] / (2 * bend), radius = unit * unit / (-2 * bend);
    const auto [half_width, max_pressure] = hertz_line(radius, effective_modulus, total);
    const Eigen::RowVectorXd of_total = Eigen::RowVectorXd::Constant(n, 1 / total), // relative changes
        of_bend = fit.row(2) / bend, of_width = (of_total - of_bend) / 2,
                             of_slope = fit.row(1) / (2 * bend) - slope * of_bend;

    // The middle's deflection, and Hertz's: Q / (pi E*) (2 ln(2/b) + 1).
    const Derived apex{ parabola[0] - slope * slope * bend,
                        fit.row(0) - slope * fit.row(1) + slope * slope * fit.row(2) };
    const double logarithm = 2 * std::log(2 / half_width) + 1;
    const Derived excess{ apex.value - flexibility * logarithm,
                          apex.by_load - flexibility * (logarithm * of_total - 2 * of_width) };

    // Sure no more where the gap is no parabola, as root mean square in parts of the gap at the contact's
    // ends, 2 Q / (pi E*), or where the load's centre and its radius of gyration, half of Hertz's half-width,
    // are not those of the strips: on five strips these are 0.2 strips off by themselves.
    constexpr double sure_gap = 0.0012, no_gap = 0.006, sure_place = 0.25, no_place = 0.5;
    const double mean_square = load.dot(misfit.cwiseAbs2()) / total,
                 distance = std::sqrt(mean_square) / (2 * flexibility);
    const Derived from_parabola{
      distance, distance > 0 ? Eigen::RowVectorXd((2 * load.cwiseProduct(misfit).transpose() * by_load +
                                                   misfit.cwiseAbs2().transpose()) *
                                                      (distance / (2 * total * mean_square)) -
                                                  1.5 * distance * of_total)
                             : Eigen::RowVectorXd::Zero(n)
    };
    Eigen::VectorXd squares(n), places(n);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        const LoadedStrip &strip = strips[static_cast<std::size_t>(i)];
        places[i] = strip.place;
        squares[i] = strip.half_width * strip.half_width / 3;
      }
    const double centre = load.dot(places) / total;
    squares += (places.array() - centre).square().matrix();
    const double gyration = std::sqrt(load.dot(squares) / total),
                 strip = (high - low) / static_cast<double>(n),
                 aside = (centre - (origin - unit * slope)) / strip,
                 wider = (2 * gyration - half_width) / strip, off = std::hypot(aside, wider);
    const Eigen::RowVectorXd aside_by =
                                 ((places.array() - centre).matrix().transpose() / total + unit * of_slope) /
                                 strip,
                             wider_by = ((squares.array() - gyration * gyration).matrix().transpose() /
                                             (total * gyration) -
                                         half_width * of_width) /
                                        strip;
    const Derived from_place{ off, off > 0 ? Eigen::RowVectorXd((aside * aside_by + wider * wider_by) / off)
                                           : Eigen::RowVectorXd::Zero(n) };
    const Derived parabolic = certainty(from_parabola, sure_gap, no_gap),
                  as_wide = certainty(from_place, sure_place, no_place);
    const double sure = parabolic.value * as_wide.value;
    if (sure == 0)
      return std::nullopt;
    const Eigen::RowVectorXd slopes =
        sure * excess.by_load +
        excess.value * (parabolic.value * as_wide.by_load + as_wide.value * parabolic.by_load);
    return LineOnStrips{ .excess_approach = sure * excess.value,
                         .excess_by_load = { slopes.begin(), slopes.end() },
                         .max_pressure = max_pressure,
                         .certainty = sure };
  }
} // namespace flank::half_space
