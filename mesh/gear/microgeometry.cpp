// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/microgeometry.hpp"

#include "mesh/base/units.hpp"

#include <fmt/format.h>

namespace flank
{
  ProfileRelief::ProfileRelief(std::string name, const double amount, const double start_roll, const double end_roll,
                               const ReliefShape shape)
      : name_(std::move(name))
      , amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
      , shape_(shape)
  {
  }

  double ProfileRelief::removed(const double roll, double) const
  {
    const double s = (roll - start_) / (end_ - start_);
    if (s <= 0)
      return 0;
    return amount_ * (shape_ == ReliefShape::linear ? s : s * s);
  }

  std::string ProfileRelief::describe() const
  {
    return fmt::format("{} {:.3f} um, {}, from roll angle {:.4f} deg to {:.4f} deg", name_, amount_ / units::micrometre,
                       shape_ == ReliefShape::linear ? "linear" : "quadratic", start_ / units::degree, end_ / units::degree);
  }

  LeadCrown::LeadCrown(const double amount, const double face_width)
      : amount_(amount)
      , face_width_(face_width)
  {
  }

  double LeadCrown::removed(double, const double z) const
  {
    const double s = 2 * z / face_width_;
    return amount_ * s * s;
  }

  std::string LeadCrown::describe() const
  {
    return fmt::format("lead crown {:.3f} um at the ends of the face width {:.3f} mm", amount_ / units::micrometre, face_width_);
  }

  double removed(const FlankModifications &modifications, const double roll, const double z)
  {
    double sum = 0;
    for (const auto &modification : modifications)
      sum += modification->removed(roll, z);
    return sum;
  }
} // namespace flank
