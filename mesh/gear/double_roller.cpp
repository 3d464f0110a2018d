// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/double_roller.hpp"

#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace flank
{
  using units::pi;

  namespace
  {
    /// After how many parts of a ring all errors repeat. Radii [mm]; positions as DoubleRollerData has them,
    /// so that those of part k stand turned by k pitches.
    int parts_until_alike(const int count, const std::vector<double> &radii,
                          const std::vector<Eigen::Vector2d> &positions)
    {
      double greatest = 0;
      for (const Eigen::Vector2d &error : positions)
        greatest = std::max(greatest, error.norm());
      const double rounding = 1e-12 * greatest;
      const auto are_alike = [&](const int one, const int other) {
        const Eigen::Rotation2Dd turn(2 * pi / count * (other - one));
        return (radii.empty() || radii[one] == radii[other]) &&
               (positions.empty() || (turn * positions[one] - positions[other]).norm() <= rounding);
      };
      for (int shift = 1; shift < count; ++shift)
        {
          int alike = 0;
          while (count % shift == 0 && alike < count && are_alike(alike, (alike + shift) % count))
            ++alike;
          if (alike == count)
            return shift;
        }
      return count;
    }
  } // namespace

  int pitches_in_period(const DoubleRollerData &data)
  {
    const int n_r = data.rollers;
    return std::lcm(parts_until_alike(n_r, data.roller_radius_error, data.roller_position_error),
                    parts_until_alike(n_r - 1, data.sleeve_radius_error, data.sleeve_position_error));
  }

  double period_of_crank(const DoubleRollerData &data)
  {
    return pitches_in_period(data) * (2 * pi / data.rollers);
  }

  DoubleRollerDrive::DoubleRollerDrive(const DoubleRollerData &data)
      : data_(data)
  {
    const int n_r = data.rollers, n_s = n_r - 1;
    const auto refuse = [](const std::string &quantity, const std::string &message) {
      throw InputError(message, quantity);
    };
    const auto chord = [](const double radius, const int n) { return 2 * radius * std::sin(pi / n); };
    if (data.roller_radius * 2 >= chord(data.roller_circle_radius, n_r))
      refuse("roller radius",
             fmt::format("neighbouring rollers overlap: {} of them leave {:.4f} mm from centre to centre, "
                         "their diameter is {:.4f} mm",
                         n_r, chord(data.roller_circle_radius, n_r), 2 * data.roller_radius));
    if (data.sleeve_radius * 2 >= chord(data.sleeve_circle_radius, n_s))
      refuse("sleeve radius",
             fmt::format("neighbouring sleeves overlap: {} of them leave {:.4f} mm from centre to centre, "
                         "their diameter is {:.4f} mm",
                         n_s, chord(data.sleeve_circle_radius, n_s), 2 * data.sleeve_radius));
    if (data.eccentricity * n_r >= data.roller_circle_radius)
      refuse("eccentricity", fmt::format("too large: the rolling circle of radius E N_r = {:.4f} mm must "
                                         "lie inside the roller circle of {:.4f} mm, "
                                         "at most {:.4f} mm is allowed",
                                         data.eccentricity * n_r, data.roller_circle_radius,
                                         data.roller_circle_radius / n_r));
    const auto size_check = [&](const std::string &quantity, const std::size_t found, const int needed) {
      if (found != 0 && found != static_cast<std::size_t>(needed))
        refuse(quantity, fmt::format("{}, needed are {} (one each)", counted(found, "number"), needed));
    };
    size_check("roller radius errors", data.roller_radius_error.size(), n_r);
    size_check("sleeve radius errors", data.sleeve_radius_error.size(), n_s);
    size_check("roller position errors", data.roller_position_error.size(), n_r);
    size_check("sleeve position errors", data.sleeve_position_error.size(), n_s);
    roller_centres_ = centres(data.roller_circle_radius, n_r, 1, data.roller_position_error);
    // Half a pitch on: any other phase interpenetrates.
    sleeve_centres_ = centres(data.sleeve_circle_radius, n_s, 0.5, data.sleeve_position_error);
    least_gap_ = find_least_gap();
    const LeastGap &least = least_gap_;
    const double overlap = least.interference, allowed = 0.01 * data.roller_radius;
    if (overlap > allowed)
      refuse("sleeve radius", fmt::format("cannot be assembled: rollers and sleeves overlap by {:.4f} mm, "
                                          "more than 1 % of the roller radius ({:.4f} mm)",
                                          overlap, allowed));
    // A quarter of the sleeves' pitch is how far the carrier turns to close a gap, at a lever that is never
    // greater than a sleeve's distance from the axis.
    const double closed = units::pi / 2 / n_s * (data.sleeve_circle_radius + data.eccentricity);
    if (std::max(least.drive, least.coast) > closed)
      refuse("sleeve radius",
             fmt::format("rollers and sleeves do not reach each other: the least gaps of the two flanks are "
                         "{:.4f} and {:.4f} mm, the carrier closes at most {:.4f} mm",
                         least.drive, least.coast, closed));
  }

  double DoubleRollerDrive::roller_pitch() const
  {
    return 2 * pi / data_.rollers;
  }

  double DoubleRollerDrive::period() const
  {
    return period_of_crank(data_);
  }

  double DoubleRollerDrive::sleeve_pitch() const
  {
    return 2 * pi / sleeves();
  }

  double DoubleRollerDrive::roller_radius(const int roller) const
  {
    return data_.roller_radius +
           (data_.roller_radius_error.empty() ? 0 : data_.roller_radius_error[roller - 1]);
  }

  double DoubleRollerDrive::sleeve_radius(const int sleeve) const
  {
    return data_.sleeve_radius +
           (data_.sleeve_radius_error.empty() ? 0 : data_.sleeve_radius_error[sleeve - 1]) - data_.clearance;
  }

  DoubleRollerDrive::Long DoubleRollerDrive::contact_distance(const int roller, const int sleeve) const
  {
    return static_cast<Long>(roller_radius(roller)) + static_cast<Long>(sleeve_radius(sleeve));
  }

  std::vector<DoubleRollerDrive::LongVector> DoubleRollerDrive::centres(
      const double radius, const int count, const Long first, const std::vector<Eigen::Vector2d> &errors)
  {
    std::vector<LongVector> result;
    for (int i = 0; i < count; ++i)
      {
        const Long angle = 2 * std::numbers::pi_v<Long> / count * (first + i);
        result.push_back(radius * LongVector(std::cos(angle), std::sin(angle)));
        if (!errors.empty())
          result.back() += errors[static_cast<std::size_t>(i)].cast<Long>();
      }
    return result;
  }

  DoubleRollerDrive::LongVector DoubleRollerDrive::carrier_axis(const double phi) const
  {
    return data_.eccentricity * LongVector(std::cos(Long(phi)), std::sin(Long(phi)));
  }

  Eigen::Vector2d DoubleRollerDrive::roller_centre(const int roller) const
  {
    return roller_centres_[roller - 1].cast<double>();
  }

  DoubleRollerDrive::Pose DoubleRollerDrive::pose(const double phi, const double psi,
                                                  std::vector<Eigen::Vector2d> shift) const
  {
    return { phi, psi, carrier_axis(phi), Eigen::Rotation2D<Long>(-psi).toRotationMatrix(),
             std::move(shift) };
  }

  DoubleRollerDrive::LongVector DoubleRollerDrive::shift_of(const int sleeve, const Pose &pose)
  {
    return pose.shift.empty() ? LongVector(0, 0)
                              : LongVector(pose.shift[static_cast<std::size_t>(sleeve - 1)].cast<Long>());
  }

  Eigen::Vector2d DoubleRollerDrive::sleeve_centre_at(const int sleeve, const Pose &pose) const
  {
    return (pose.carrier_axis + pose.carrier * sleeve_centres_[sleeve - 1] + shift_of(sleeve, pose))
        .cast<double>();
  }

  RollerPair DoubleRollerDrive::pair(const int roller, const int sleeve, const Pose &pose) const
  {
    const LongVector &axis = pose.carrier_axis;                        // O2
    const LongVector arm = pose.carrier * sleeve_centres_[sleeve - 1], // S_n - O2
        d = roller_centres_[roller - 1] - axis - arm - shift_of(sleeve, pose);
    const Long distance = d.norm();
    const LongVector t = d / distance;
    return { roller, sleeve, static_cast<double>(distance - contact_distance(roller, sleeve)),
             static_cast<double>(-t.dot(LongVector(arm.y(), -arm.x()))),
             static_cast<double>(t.dot(LongVector(-axis.y(), axis.x()))) };
  }

  std::vector<int> DoubleRollerDrive::rollers_around(const int sleeve, const Pose &pose) const
  {
    return rollers_around(sleeve_centre_at(sleeve, pose));
  }

  std::vector<int> DoubleRollerDrive::rollers_around(const Eigen::Vector2d &centre) const
  {
    const int below = static_cast<int>(std::floor(std::atan2(centre.y(), centre.x()) / roller_pitch()));
    std::vector<int> result;
    for (int i = 0; i < std::min(4, data_.rollers); ++i)
      result.push_back(((below - 2 + i) % data_.rollers + data_.rollers) % data_.rollers + 1);
    std::sort(result.begin(), result.end());
    return result;
  }

  std::vector<RollerPair> DoubleRollerDrive::pairs(const double phi, const double psi,
                                                   const double reach) const
  {
    const Pose at = pose(phi, psi);
    std::vector<RollerPair> result;
    for (int n = 1; n <= sleeves(); ++n)
      for (const int k : rollers_around(n, at))
        if (const RollerPair p = pair(k, n, at); p.gap <= reach)
          result.push_back(p);
    return result;
  }

  double DoubleRollerDrive::contact_rotation(const int roller, const int sleeve, const double phi,
                                             const DriveFlank flank) const
  {
    const LongVector c = roller_centres_[roller - 1] - carrier_axis(phi), s = sleeve_centres_[sleeve - 1];
    const Long rho = c.norm(), r1 = s.norm(), reach = contact_distance(roller, sleeve);
    const Long cosine = (rho * rho + r1 * r1 - reach * reach) / (2 * rho * r1);
    if (std::abs(cosine) > 1)
      return std::numeric_limits<double>::quiet_NaN();
    const Long gamma = std::acos(cosine), nominal = nominal_psi(phi);
    const Long raw =
        std::atan2(s.y(), s.x()) - std::atan2(c.y(), c.x()) + (flank == DriveFlank::drive ? gamma : -gamma);
    return static_cast<double>(nominal + std::remainder(raw - nominal, 2 * std::numbers::pi_v<Long>));
  }

  namespace
  {
    /// Of a roller and a sleeve at a crank angle. [mm] The gap closes by lever times a rotation of the
    /// carrier in its flank's sense.
    struct GapAndLever
    {
      double gap, lever;
    };

    /// By how much the pair that overlaps most does so where the carrier is turned as suits all of them. [mm]
    double interference(const std::vector<GapAndLever> &drive, const std::vector<GapAndLever> &coast)
    {
      double most = 0;
      for (const GapAndLever &d : drive)
        for (const GapAndLever &c : coast)
          if (d.lever + c.lever > 0)
            most = std::max(most, -(d.gap * c.lever + c.gap * d.lever) / (d.lever + c.lever));
      return most;
    }
  } // namespace

  DoubleRollerDrive::LeastGap DoubleRollerDrive::find_least_gap() const
  {
    LeastGap least{ 1e300, 1e300 };
    // A sleeve passes a roller within about a turn of the crank: 720 steps of one, fewer where there are many
    // parts and a period of many turns.
    constexpr int steps = 720;
    const double range = period();
    const int turn = std::clamp(static_cast<int>(3e6 / (1.0 * sleeves() * sleeves())), 30, steps);
    const int count = std::max(steps, static_cast<int>(std::lround(turn * range / (2 * pi))));
    std::vector<Eigen::Vector2d> rollers, arms;
    for (int k = 1; k <= data_.rollers; ++k)
      rollers.push_back(roller_centre(k));
    for (int n = 1; n <= sleeves(); ++n)
      arms.push_back(sleeve_centres_[n - 1].cast<double>());
    for (int i = 0; i < count; ++i)
      {
        const double phi = range * i / count;
        const Eigen::Vector2d axis = data_.eccentricity * Eigen::Vector2d(std::cos(phi), std::sin(phi));
        const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-nominal_psi(phi)).toRotationMatrix();
        std::vector<GapAndLever> drive, coast;
        for (int n = 1; n <= sleeves(); ++n)
          {
            const Eigen::Vector2d arm = turned * arms[n - 1], centre = axis + arm;
            for (const int k : rollers_around(centre))
              {
                const Eigen::Vector2d d = rollers[k - 1] - centre;
                const double gap = d.norm() - static_cast<double>(contact_distance(k, n)),
                             lever = (d.y() * arm.x() - d.x() * arm.y()) / d.norm();
                double &side = lever > 0 ? least.drive : least.coast;
                side = std::min(side, gap);
                (lever > 0 ? drive : coast).push_back({ gap, std::abs(lever) });
              }
          }
        least.interference = std::max(least.interference, interference(drive, coast));
      }
    return least;
  }

  /// A roller centre seen from the carrier, in units that close after one sleeve pitch: the curtate trochoid
  /// of the double-roller actuator article (bibliography in contact/bibliography.md), eq. 3, without its
  /// parallel offset.
  Eigen::Vector2d DoubleRollerDrive::conjugate_point(const double t) const
  {
    return { data_.roller_circle_radius * std::cos(t) - data_.eccentricity * std::cos(data_.rollers * t),
             data_.roller_circle_radius * std::sin(t) - data_.eccentricity * std::sin(data_.rollers * t) };
  }

  Eigen::Vector2d DoubleRollerDrive::conjugate_tangent(const double t) const
  {
    const double R = data_.roller_circle_radius, e = data_.eccentricity, n = data_.rollers;
    return { -R * std::sin(t) + e * n * std::sin(n * t), R * std::cos(t) - e * n * std::cos(n * t) };
  }

  DoubleRollerDrive::ConjugateExtremes DoubleRollerDrive::conjugate_extremes() const
  {
    ConjugateExtremes r{
      .least_convex = 1e300, .least_hollow = {}, .least_departure = 1e300, .most_departure = -1e300
    };
    constexpr int samples = 2000;
    for (int i = 0; i <= samples; ++i)
      {
        const double t = sleeve_pitch() * i / samples, radius = conjugate_radius(t),
                     departure = conjugate_departure(t);
        if (radius > 0)
          r.least_convex = std::min(r.least_convex, radius);
        else
          r.least_hollow = std::min(r.least_hollow.value_or(1e300), -radius);
        r.least_departure = std::min(r.least_departure, departure);
        r.most_departure = std::max(r.most_departure, departure);
      }
    return r;
  }

  double DoubleRollerDrive::conjugate_radius(const double t) const
  {
    const double R = data_.roller_circle_radius, e = data_.eccentricity, n = data_.rollers;
    const Eigen::Vector2d tangent = conjugate_tangent(t);
    const double x1 = tangent.x(), y1 = tangent.y();
    const double x2 = -R * std::cos(t) + e * n * n * std::cos(n * t),
                 y2 = -R * std::sin(t) + e * n * n * std::sin(n * t);
    const double of_centres =
        std::pow(x1 * x1 + y1 * y1, 1.5) / (x1 * y2 - y1 * x2); // positive: bulges outwards
    return of_centres - data_.roller_radius;
  }

  ConjugateContact DoubleRollerDrive::conjugate_contact(const int roller, const double phi) const
  {
    // Seen from the carrier a roller's centre runs along the trochoid at t = its angle + psi; back in the
    // fixed frame the outward normal of the trochoid points from the profile to the roller.
    const double psi = nominal_psi(phi), t = roller_pitch() * roller + psi;
    const Eigen::Vector2d tangent = conjugate_tangent(t).normalized();
    const Eigen::Vector2d normal(tangent.y(), -tangent.x()),
        point = conjugate_point(t) - data_.roller_radius * normal; // in the carrier's frame
    const double pitch = sleeve_pitch(), angle = std::atan2(point.y(), point.x());
    const int lobe = static_cast<int>(std::floor(angle / pitch)) + 1;
    return { (lobe + sleeves() - 1) % sleeves() + 1, -normal.dot(Eigen::Vector2d(point.y(), -point.x())),
             conjugate_radius(t), normal };
  }

  double DoubleRollerDrive::conjugate_departure(const double t) const
  {
    // Both have the same centre line: the distance of the roller's centre from the nearest sleeve centre,
    // less the radii.
    const Eigen::Vector2d p = conjugate_point(t);
    const double pitch = sleeve_pitch(), angle = std::atan2(p.y(), p.x());
    double least = 1e300;
    for (int k = -1; k <= 1; ++k)
      {
        const double a = (std::floor(angle / pitch) + k + 0.5) * pitch;
        const Eigen::Vector2d s = data_.sleeve_circle_radius * Eigen::Vector2d(std::cos(a), std::sin(a));
        least = std::min(least, (p - s).norm());
      }
    return least - data_.roller_radius - data_.sleeve_radius;
  }
} // namespace flank
