// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/microgeometry.hpp"

#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

namespace flank
{
  namespace
  {
    double power(const double s, const ReliefShape shape)
    {
      return s <= 0 ? 0 : shape == ReliefShape::linear ? s : s * s;
    }

    double power_slope(const double s, const ReliefShape shape)
    {
      return s <= 0 ? 0 : shape == ReliefShape::linear ? 1 : 2 * s;
    }

    /// A roll angle in the three ways drawings give it: degrees, diameter, length of roll.
    std::string place(const double roll, const double base_radius)
    {
      return fmt::format("{:.4f} deg (diameter {:.4f} mm, length of roll {:.4f} mm)", roll / units::degree,
                         2 * base_radius * std::hypot(1.0, roll), base_radius * roll);
    }

    /// A copy of a modification with another value of one of its members.
    template <class Modification>
    std::shared_ptr<const FlankModification> copy_with(const Modification &of,
                                                       double std::type_identity_t<Modification>::*member,
                                                       const double value)
    {
      const auto copy = std::make_shared<Modification>(of);
      (*copy).*member = value;
      return copy;
    }

    const char *name_of(const ReliefShape shape)
    {
      return shape == ReliefShape::linear ? "linear" : "quadratic";
    }
  } // namespace

  ProfileRelief::ProfileRelief(std::string name, const double amount, const double start_roll,
                               const double end_roll, const ReliefShape shape)
      : name_(std::move(name))
      , amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
      , shape_(shape)
  {
  }

  double ProfileRelief::removed(const double roll, double) const
  {
    return amount_ * power((roll - start_) / (end_ - start_), shape_);
  }

  double ProfileRelief::derivative(const Parameter by, const double roll, double) const
  {
    const double s = (roll - start_) / (end_ - start_);
    return by == Parameter::amount  ? power(s, shape_)
           : by == Parameter::start ? amount_ * power_slope(s, shape_) * (s - 1) / (end_ - start_)
                                    : 0;
  }

  std::shared_ptr<const FlankModification> ProfileRelief::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount  ? copy_with(*this, &ProfileRelief::amount_, value)
           : by == Parameter::start ? copy_with(*this, &ProfileRelief::start_, value)
                                    : nullptr;
  }

  std::string ProfileRelief::describe(const double base_radius) const
  {
    return fmt::format("{} {:.3f} um, {}, from roll angle {} to {}", name_, amount_ / units::micrometre,
                       name_of(shape_), place(start_, base_radius), place(end_, base_radius));
  }

  OverProfile::OverProfile(const double amount, const double start_roll, const double end_roll)
      : amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
  {
  }

  OverFaceWidth::OverFaceWidth(const double amount, const double face_width)
      : amount_(amount)
      , face_width_(face_width)
  {
  }

  double LeadCrown::removed(double, const double z) const
  {
    return amount_ * derivative(Parameter::amount, 0, z);
  }

  double LeadCrown::derivative(const Parameter by, double, const double z) const
  {
    const double s = 2 * z / face_width_;
    return by == Parameter::amount ? s * s : 0;
  }

  std::shared_ptr<const FlankModification> LeadCrown::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount ? copy_with(*this, &LeadCrown::amount_, value) : nullptr;
  }

  std::string LeadCrown::describe(const double) const
  {
    return fmt::format("lead crown {:.3f} um at the ends of the face width {:.3f} mm",
                       amount_ / units::micrometre, face_width_);
  }

  double ProfileSlope::removed(const double roll, double) const
  {
    return amount_ * derivative(Parameter::amount, roll, 0);
  }

  double ProfileSlope::derivative(const Parameter by, const double roll, double) const
  {
    return by == Parameter::amount ? s(roll) - 0.5 : 0;
  }

  std::shared_ptr<const FlankModification> ProfileSlope::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount ? copy_with(*this, &ProfileSlope::amount_, value) : nullptr;
  }

  std::string ProfileSlope::describe(const double) const
  {
    return fmt::format("profile slope {:.3f} um from roll angle {:.4f} deg to {:.4f} deg (positive: less "
                       "material at the tip)",
                       amount_ / units::micrometre, start_ / units::degree, end_ / units::degree);
  }

  double ProfileCrown::removed(const double roll, double) const
  {
    return amount_ * derivative(Parameter::amount, roll, 0);
  }

  double ProfileCrown::derivative(const Parameter by, const double roll, double) const
  {
    const double t = 2 * s(roll) - 1;
    return by == Parameter::amount ? t * t : 0;
  }

  std::shared_ptr<const FlankModification> ProfileCrown::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount ? copy_with(*this, &ProfileCrown::amount_, value) : nullptr;
  }

  std::string ProfileCrown::describe(const double) const
  {
    return fmt::format("profile crown {:.3f} um at roll angles {:.4f} deg and {:.4f} deg",
                       amount_ / units::micrometre, start_ / units::degree, end_ / units::degree);
  }

  double HelixSlope::removed(double, const double z) const
  {
    return amount_ * z / face_width_;
  }

  double HelixSlope::derivative(const Parameter by, double, const double z) const
  {
    return by == Parameter::amount ? z / face_width_ : 0;
  }

  std::shared_ptr<const FlankModification> HelixSlope::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount ? copy_with(*this, &HelixSlope::amount_, value) : nullptr;
  }

  std::string HelixSlope::describe(const double) const
  {
    return fmt::format("helix slope {:.3f} um over the face width {:.3f} mm (positive: less material at +z)",
                       amount_ / units::micrometre, face_width_);
  }

  EndRelief::EndRelief(const double amount, const double length, const double face_width, const int end,
                       const ReliefShape shape)
      : amount_(amount)
      , length_(length)
      , face_width_(face_width)
      , end_(end)
      , shape_(shape)
  {
  }

  double EndRelief::removed(double, const double z) const
  {
    const double towards_end = end_ == 0 ? std::abs(z) : end_ * z;
    return amount_ * power(1 - (face_width_ / 2 - towards_end) / length_, shape_);
  }

  double EndRelief::derivative(const Parameter by, double, const double z) const
  {
    const double distance = face_width_ / 2 - (end_ == 0 ? std::abs(z) : end_ * z),
                 s = 1 - distance / length_;
    return by == Parameter::amount   ? power(s, shape_)
           : by == Parameter::length ? amount_ * power_slope(s, shape_) * distance / (length_ * length_)
                                     : 0;
  }

  std::shared_ptr<const FlankModification> EndRelief::with(const Parameter by, const double value) const
  {
    return by == Parameter::amount   ? copy_with(*this, &EndRelief::amount_, value)
           : by == Parameter::length ? copy_with(*this, &EndRelief::length_, value)
                                     : nullptr;
  }

  std::string EndRelief::describe(const double) const
  {
    return fmt::format("end relief {:.3f} um, {}, over {:.3f} mm at {}", amount_ / units::micrometre,
                       name_of(shape_), length_,
                       end_ == 0  ? "both face ends"
                       : end_ < 0 ? "the face end at -z"
                                  : "the face end at +z");
  }

  CornerBias::CornerBias(const int corner, const double amount, const double start_roll,
                         const double end_roll, const double length, const double face_width,
                         const int face_end, const ReliefShape shape)
      : corner_(corner)
      , amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
      , length_(length)
      , face_width_(face_width)
      , face_end_(face_end)
      , shape_(shape)
  {
  }

  double CornerBias::removed(const double roll, const double z) const
  {
    const double u = (roll - start_) / (end_ - start_), v = (face_width_ / 2 - face_end_ * z) / length_;
    return amount_ * power(u - v, shape_);
  }

  double CornerBias::derivative(const Parameter by, const double roll, const double z) const
  {
    const double u = (roll - start_) / (end_ - start_), v = (face_width_ / 2 - face_end_ * z) / length_;
    return by == Parameter::amount  ? power(u - v, shape_)
           : by == Parameter::start ? amount_ * power_slope(u - v, shape_) * (u - 1) / (end_ - start_)
                                    : amount_ * power_slope(u - v, shape_) * v / length_;
  }

  std::shared_ptr<const FlankModification> CornerBias::with(const Parameter by, const double value) const
  {
    return copy_with(*this,
                     by == Parameter::amount  ? &CornerBias::amount_
                     : by == Parameter::start ? &CornerBias::start_
                                              : &CornerBias::length_,
                     value);
  }

  std::string CornerBias::describe(const double base_radius) const
  {
    return fmt::format("bias corner {} ({}, {} at {}z) {:.3f} um, {}, from roll angle {} at the face end to "
                       "{:.3f} mm along the {}",
                       corner_, corner_ % 2 ? "bias-in" : "bias-out", corner_ <= 2 ? "tip" : "root",
                       face_end_ > 0 ? "+" : "-", amount_ / units::micrometre, name_of(shape_),
                       place(start_, base_radius), length_, corner_ <= 2 ? "tip" : "start of active profile");
  }

  double removed(const FlankModifications &modifications, const double roll, const double z)
  {
    double sum = 0;
    for (const auto &modification : modifications)
      sum += modification->removed(roll, z);
    return sum;
  }
} // namespace flank
