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

    /// The strips of a contact; t, the place across it, runs from -1 to 1 over all of them.
    struct Contact
    {
      const std::vector<LoadedStrip> &strips;
      Eigen::VectorXd load, place, half_width; ///< of the strips, from the middle of them all [N/mm], [mm]
      double origin = 0, half = 0;             ///< middle and half-width of them all [mm]

      explicit Contact(const std::vector<LoadedStrip> &of)
          : strips(of)
          , load(of.size())
          , place(of.size())
          , half_width(of.size())
      {
        for (std::size_t i = 0; i < of.size(); ++i)
          {
            const auto k = static_cast<Eigen::Index>(i);
            load[k] = of[i].load_per_length;
            place[k] = of[i].place;
            half_width[k] = of[i].half_width;
          }
        const double low = (place - half_width).minCoeff(), high = (place + half_width).maxCoeff();
        origin = (low + high) / 2;
        half = (high - low) / 2;
        place.array() -= origin;
      }

      double mean_strip() const { return 2 * half / static_cast<double>(load.size()); } ///< [mm]

      /// Means of 1, t and t^2 over the strips: a row each.
      Eigen::MatrixXd means() const
      {
        Eigen::MatrixXd result(load.size(), 3);
        result.col(0).setOnes();
        result.col(1) = place / half;
        result.col(2) = (place.array().square() + half_width.array().square() / 3) / (half * half);
        return result;
      }

      /// Mean deflections of the strips by unit line loads on each, from an origin that is the same for all
      /// loads in mm. [mm mm/N]
      Eigen::MatrixXd influence(const double effective_modulus) const
      {
        const Eigen::Index n = load.size();
        Eigen::MatrixXd result(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
          for (Eigen::Index j = 0; j <= i; ++j)
            result(i, j) = result(j, i) =
                -2 / (pi * effective_modulus) *
                mean_logarithm(strips[static_cast<std::size_t>(i)], strips[static_cast<std::size_t>(j)]);
        return result;
      }
    };

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
    /// Hertz's contact whose gap is the parabola through what strips deflect by.
    struct Fitted
    {
      Derived apex, middle, half_width; ///< deflection at the middle; its place; as wide as Hertz's [mm]
      Derived misfit;      ///< of the parabola: root mean square in parts of the gap at the contact's ends
      double max_pressure; ///< [MPa]
    };

    /// Least squares weighted by the loads: a strip that has just touched changes nothing. Nothing: the gap
    /// does not open.
    std::optional<Fitted> fitted(const Contact &contact, const double effective_modulus)
    {
      const Eigen::VectorXd &load = contact.load;
      const double total = load.sum(), gap_at_ends = 2 * total / (pi * effective_modulus);
      const Eigen::MatrixXd means = contact.means(), by_load = contact.influence(effective_modulus),
                            weighted = load.asDiagonal() * means;
      const Eigen::VectorXd deflected = by_load * load;
      const auto normal = (means.transpose() * weighted).eval().ldlt();
      const Eigen::Vector3d parabola = normal.solve(weighted.transpose() * deflected);
      if (!(parabola[2] < 0))
        return std::nullopt;
      const Eigen::VectorXd misfit = deflected - means * parabola;
      const Eigen::MatrixXd fit = normal.solve(weighted.transpose() * by_load +
                                               means.transpose() * Eigen::MatrixXd(misfit.asDiagonal()));

      const double bend = parabola[2], slope = parabola[1] / (2 * bend);
      const auto [half_width, max_pressure] =
          hertz_line(contact.half * contact.half / (-2 * bend), effective_modulus, total);
      const Eigen::RowVectorXd of_total = Eigen::RowVectorXd::Constant(load.size(), 1 / total),
                               of_bend = fit.row(2) / bend; // relative changes
      const double mean_square = load.dot(misfit.cwiseAbs2()) / total,
                   distance = std::sqrt(mean_square) / gap_at_ends;
      Eigen::RowVectorXd distance_by = Eigen::RowVectorXd::Zero(load.size());
      if (distance > 0)
        distance_by = (2 * load.cwiseProduct(misfit).transpose() * by_load + misfit.cwiseAbs2().transpose()) *
                          (distance / (2 * total * mean_square)) -
                      1.5 * distance * of_total;
      return Fitted{ .apex = { parabola[0] - slope * slope * bend,
                               fit.row(0) - slope * fit.row(1) + slope * slope * fit.row(2) },
                     .middle = { -contact.half * slope,
                                 -contact.half * (fit.row(1) / (2 * bend) - slope * of_bend) },
                     .half_width = { half_width, half_width / 2 * (of_total - of_bend) },
                     .misfit = { distance, distance_by },
                     .max_pressure = max_pressure };
    }

    /// How much further the bodies come together on strips than Hertz's, Q / (pi E*) (2 ln(2/b) + 1). [mm]
    Derived excess_of(const Fitted &line, const double total, const double effective_modulus)
    {
      const double flexibility = 1 / (pi * effective_modulus), b = line.half_width.value,
                   logarithm = 2 * std::log(2 / b) + 1;
      return { line.apex.value - flexibility * total * logarithm,
               (line.apex.by_load + 2 * flexibility * total / b * line.half_width.by_load).array() -
                   flexibility * logarithm };
    }

    /// How far the load's centre and its radius of gyration, half of Hertz's half-width, are from those of
    /// the contact, in strips.
    Derived off_place(const Contact &contact, const Fitted &line)
    {
      const Eigen::VectorXd &load = contact.load;
      const double total = load.sum(), centre = load.dot(contact.place) / total;
      const Eigen::RowVectorXd from_centre = contact.place.transpose().array() - centre,
                               squares = from_centre.array().square() +
                                         contact.half_width.transpose().array().square() / 3;
      const double gyration = std::sqrt(squares.dot(load) / total), strip = contact.mean_strip(),
                   aside = (centre - line.middle.value) / strip,
                   wider = (2 * gyration - line.half_width.value) / strip, off = std::hypot(aside, wider);
      if (off == 0)
        return { off, Eigen::RowVectorXd::Zero(load.size()) };
      const Eigen::RowVectorXd aside_by = from_centre / total - line.middle.by_load,
                               gyration_by = (squares.array() - gyration * gyration) / (2 * gyration * total),
                               wider_by = 2 * gyration_by - line.half_width.by_load;
      return { off, (aside * aside_by + wider * wider_by) / (off * strip) };
    }
  } // namespace

  std::optional<LineOnStrips> line_on_strips(const std::vector<LoadedStrip> &strips,
                                             const double effective_modulus)
  {
    // A parabola goes through any three strips; where the load lies then tells alone whether it is one.
    constexpr std::size_t fewest = 3;
    if (strips.size() < fewest)
      return std::nullopt;
    const Contact contact(strips);
    const std::optional<Fitted> line = fitted(contact, effective_modulus);
    if (!line)
      return std::nullopt;
    // On five strips Hertz's own contact is 0.2 strips off its place.
    const Derived excess = excess_of(*line, contact.load.sum(), effective_modulus),
                  parabolic = certainty(line->misfit, 0.0012, 0.006),
                  placed = certainty(off_place(contact, *line), 0.25, 0.5);
    const double sure = parabolic.value * placed.value;
    if (sure == 0)
      return std::nullopt;
    const Eigen::RowVectorXd slopes =
        sure * excess.by_load +
        excess.value * (parabolic.value * placed.by_load + placed.value * parabolic.by_load);
    return LineOnStrips{ .excess_approach = sure * excess.value,
                         .excess_by_load = { slopes.begin(), slopes.end() },
                         .max_pressure = line->max_pressure,
                         .certainty = sure };
  }
} // namespace flank::half_space
