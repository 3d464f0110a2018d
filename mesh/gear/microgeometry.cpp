// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/microgeometry.hpp"

#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace flank
{
  namespace
  {
    /// s^n beyond its start; a linear start is rounded from -h to h, where its slope grows evenly.
    double power(const double s, const ReliefForm &form, const double h)
    {
      return s <= -h                             ? 0
             : form.shape != ReliefShape::linear ? s * s
             : s >= h                            ? s
                                                 : (s + h) * (s + h) / (4 * h);
    }

    double power_slope(const double s, const ReliefForm &form, const double h)
    {
      return s <= -h ? 0 : form.shape != ReliefShape::linear ? 2 * s : s >= h ? 1 : (s + h) / (2 * h);
    }

    /// Derivative by the logarithm of h.
    double power_by_blend(const double s, const double h)
    {
      return std::abs(s) < h ? (h * h - s * s) / (4 * h) : 0;
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

    std::string name_of(const ReliefForm &form)
    {
      return form.shape != ReliefShape::linear ? "quadratic"
             : form.blend_radius == 0
                 ? "linear"
                 : fmt::format("linear with its start rounded by {:.4g} mm", form.blend_radius);
    }
  } // namespace

  ProfileRelief::ProfileRelief(std::string name, const double amount, const double start_roll,
                               const double end_roll, const ReliefForm form, const double base_radius)
      : name_(std::move(name))
      , amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
      , base_radius_(base_radius)
      , form_(form)
  {
  }

  bool FlankModification::starts_within(const double roll_low, const double roll_high, const double z_low,
                                        const double z_high) const
  {
    // Reliefs of both ends are even in z, least at mid-face.
    const double nearest = std::clamp(0.0, z_low, z_high);
    const auto [least, greatest] =
        std::minmax({ beyond_start(roll_low, z_low), beyond_start(roll_low, nearest),
                      beyond_start(roll_low, z_high), beyond_start(roll_high, z_low),
                      beyond_start(roll_high, nearest), beyond_start(roll_high, z_high) });
    return least <= 0 && greatest >= 0;
  }

  double relief_gradient(const double base_radius, const double start_roll, const double end_roll)
  {
    return 1 / (base_radius * start_roll * (end_roll - start_roll));
  }

  double corner_gradient(const double base_radius, const double start_roll, const double end_roll,
                         const double length)
  {
    return std::hypot(relief_gradient(base_radius, start_roll, end_roll), 1 / length);
  }

  double ProfileRelief::gradient() const
  {
    return relief_gradient(base_radius_, start_, end_);
  }

  double ProfileRelief::removed(const double roll, double) const
  {
    return amount_ * power(beyond_start(roll, 0), form_, form_.half_blend(amount_, gradient()));
  }

  double ProfileRelief::beyond_start(const double roll, double) const
  {
    return (roll - start_) / (end_ - start_);
  }

  double ProfileRelief::derivative(const Parameter by, const double roll, double) const
  {
    const double s = (roll - start_) / (end_ - start_), h = form_.half_blend(amount_, gradient());
    return by == Parameter::amount ? power(s, form_, h) + power_by_blend(s, h)
           : by == Parameter::start
               ? amount_ * (power_slope(s, form_, h) * (s - 1) / (end_ - start_) +
                            power_by_blend(s, h) * 2 * (1 / (end_ - start_) - 1 / start_))
               : 0;
  }

  FlankModification::Turn ProfileRelief::turn() const
  {
    if (form_.shape != ReliefShape::linear || amount_ == 0)
      return {};
    return { .along_profile = 2 * form_.half_blend(amount_, gradient()) / std::abs(gradient()) };
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
                       name_of(form_), place(start_, base_radius), place(end_, base_radius));
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
                       const ReliefForm form)
      : amount_(amount)
      , length_(length)
      , face_width_(face_width)
      , end_(end)
      , form_(form)
  {
  }

  double EndRelief::removed(double, const double z) const
  {
    const double towards_end = end_ == 0 ? std::abs(z) : end_ * z;
    return amount_ * power(1 - (face_width_ / 2 - towards_end) / length_, form_,
                           form_.half_blend(amount_, 1 / length_));
  }

  double EndRelief::derivative(const Parameter by, double, const double z) const
  {
    const double distance = face_width_ / 2 - (end_ == 0 ? std::abs(z) : end_ * z),
                 s = 1 - distance / length_, h = form_.half_blend(amount_, 1 / length_);
    return by == Parameter::amount ? power(s, form_, h) + power_by_blend(s, h)
           : by == Parameter::length
               ? amount_ * (power_slope(s, form_, h) * distance / length_ - 2 * power_by_blend(s, h)) /
                     length_
               : 0;
  }

  /// Reliefs of both ends that meet have a crest between them, whatever their shape.
  FlankModification::Turn EndRelief::turn() const
  {
    if (ends_meet())
      return { .along_face = 0 };
    if (form_.shape != ReliefShape::linear || amount_ == 0)
      return {};
    return { .along_face = 2 * form_.half_blend(amount_, 1 / length_) * length_ };
  }

  bool EndRelief::ends_meet() const
  {
    return end_ == 0 && amount_ != 0 &&
           1 - face_width_ / 2 / length_ > -form_.half_blend(amount_, 1 / length_);
  }

  double EndRelief::beyond_start(double, const double z) const
  {
    return ends_meet() ? z : 1 - (face_width_ / 2 - (end_ == 0 ? std::abs(z) : end_ * z)) / length_;
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
                       name_of(form_), length_,
                       end_ == 0  ? "both face ends"
                       : end_ < 0 ? "the face end at -z"
                                  : "the face end at +z");
  }

  CornerBias::CornerBias(const int corner, const double amount, const double start_roll,
                         const double end_roll, const double length, const double face_width,
                         const int face_end, const ReliefForm form, const double base_radius)
      : corner_(corner)
      , amount_(amount)
      , start_(start_roll)
      , end_(end_roll)
      , length_(length)
      , face_width_(face_width)
      , base_radius_(base_radius)
      , face_end_(face_end)
      , form_(form)
  {
  }

  double CornerBias::along_profile() const
  {
    return relief_gradient(base_radius_, start_, end_);
  }

  double CornerBias::half_blend() const
  {
    return form_.half_blend(amount_, corner_gradient(base_radius_, start_, end_, length_));
  }

  double CornerBias::removed(const double roll, const double z) const
  {
    return amount_ * power(beyond_start(roll, z), form_, half_blend());
  }

  double CornerBias::beyond_start(const double roll, const double z) const
  {
    return (roll - start_) / (end_ - start_) - (face_width_ / 2 - face_end_ * z) / length_;
  }

  double CornerBias::derivative(const Parameter by, const double roll, const double z) const
  {
    const double u = (roll - start_) / (end_ - start_), v = (face_width_ / 2 - face_end_ * z) / length_,
                 h = half_blend();
    if (by == Parameter::amount)
      return power(u - v, form_, h) + power_by_blend(u - v, h);
    // The square of the gradient has a share along the profile, which the start changes, and one along z.
    const double p = along_profile(), share = p * p / (p * p + 1 / (length_ * length_)),
                 slope = power_slope(u - v, form_, h), by_blend = 2 * power_by_blend(u - v, h);
    return by == Parameter::start ? amount_ * (slope * (u - 1) / (end_ - start_) +
                                               by_blend * share * (1 / (end_ - start_) - 1 / start_))
                                  : amount_ * (slope * v - by_blend * (1 - share)) / length_;
  }

  FlankModification::Turn CornerBias::turn() const
  {
    if (form_.shape != ReliefShape::linear || amount_ == 0)
      return {};
    return { .along_profile = 2 * half_blend() / std::abs(along_profile()),
             .along_face = 2 * half_blend() * length_ };
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
                       face_end_ > 0 ? "+" : "-", amount_ / units::micrometre, name_of(form_),
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
