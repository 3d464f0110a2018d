// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// One deviation of a flank from the involute helicoid, as material removed along the flank's normal.
  /// A new kind of modification is a new class; nothing in the contact code knows the kinds.
  class FlankModification
  {
  public:
    virtual ~FlankModification() = default;

    /// Material removed at a roll angle [rad] and face position z [mm] (user's axis, 0 at the gear's
    /// mid-face). [mm] Never negative for what is ground off; slopes and measured flanks deviate to both
    /// sides.
    virtual double removed(double roll, double z) const = 0;

    /// The numbers that describe a modification, besides its shape. [mm, rad of roll, mm]
    enum class Parameter
    {
      amount,
      start,
      length
    };

    /// Derivative of removed() by a parameter at a roll angle and face position, exact away from where the
    /// modification starts; 0: it has no such parameter.
    virtual double derivative(Parameter, double, double) const { return 0; }

    /// How suddenly the slope of a modification changes where it starts: the lengths along the profile and
    /// along the face over which it does. [mm] 0: it jumps (a kink), where the contact pressure has no bound
    /// and grows as cells shrink; infinite: it changes nowhere.
    struct Turn
    {
      double along_profile = std::numeric_limits<double>::infinity();
      double along_face = std::numeric_limits<double>::infinity();
    };
    virtual Turn turn() const { return {}; }

    /// How far a place lies beyond the line where the modification starts, and its slope changes: negative
    /// before it, in a measure of its own that is linear across the line. Infinite: it starts nowhere; zero:
    /// it may turn anywhere.
    virtual double beyond_start(double, double) const { return std::numeric_limits<double>::infinity(); }

    /// Whether the line where it starts crosses a piece of the flank: [rad of roll], [mm].
    bool starts_within(double roll_low, double roll_high, double z_low, double z_high) const;

    /// The same modification with another value of a parameter [mm, rad of roll, mm]; null: it has no such
    /// parameter.
    virtual std::shared_ptr<const FlankModification> with(Parameter, double) const { return nullptr; }

    /// One line for reports, with units; roll angles also as diameters and lengths of roll on this base
    /// radius [mm].
    virtual std::string describe(double base_radius) const = 0;
  };

  using FlankModifications = std::vector<std::shared_ptr<const FlankModification>>;

  enum class ReliefShape
  {
    linear,
    quadratic
  };

  /// How a relief grows: s, s^2, or s with its start rounded as grinding leaves it.
  struct ReliefForm
  {
    ReliefForm(const ReliefShape of, const double blended_by = 0)
        : shape(of)
        , blend_radius(blended_by)
    {
    }

    ReliefShape shape;

    /// Radius of the arc that rounds the kink where a linear relief starts, measured along the flank; 0: the
    /// kink stays. [mm]
    double blend_radius;

    /// Half of the rounding arc's length, measured in s, for a relief of this amount [mm] whose s grows by
    /// `gradient` along the flank [1/mm]. The arc turns by amount times gradient.
    double half_blend(const double amount, const double gradient) const
    {
      return blend_radius == 0 ? 0 : blend_radius * amount * gradient * gradient / 2;
    }
  };

  /// How fast s = (roll - start)/(end - start) grows along the profile at the start of a relief, per length
  /// of arc. [1/mm]
  double relief_gradient(double base_radius, double start_roll, double end_roll);

  /// The same of a corner's bias, which grows along the profile and, over a length [mm], along the face.
  double corner_gradient(double base_radius, double start_roll, double end_roll, double length);

  /// a s^n with s = (roll - start)/(end - start) beyond `start`, n = 1 or 2. end > start: tip relief; end <
  /// start: root relief.
  class ProfileRelief : public FlankModification
  {
  public:
    /// The base radius [mm] tells how long the flank is along a blend.
    ProfileRelief(std::string name, double amount, double start_roll, double end_roll, ReliefForm form,
                  double base_radius);
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    Turn turn() const override;
    double beyond_start(double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;

  private:
    double gradient() const; ///< of s along the flank, where the relief starts [1/mm]

    std::string name_;
    double amount_, start_, end_, base_radius_;
    ReliefForm form_;
  };

  /// A modification that varies over the active profile, by s = (roll - start)/(end - start).
  class OverProfile : public FlankModification
  {
  public:
    OverProfile(double amount, double start_roll, double end_roll);

  protected:
    double s(double roll) const { return (roll - start_) / (end_ - start_); }
    double amount_, start_, end_;
  };

  /// a (s - 1/2): more is removed towards the tip if a > 0.
  class ProfileSlope : public OverProfile
  {
  public:
    using OverProfile::OverProfile;
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;
  };

  /// a (2 s - 1)^2: barrelling of the profile.
  class ProfileCrown : public OverProfile
  {
  public:
    using OverProfile::OverProfile;
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;
  };

  /// A modification that varies over the face width b.
  class OverFaceWidth : public FlankModification
  {
  public:
    OverFaceWidth(double amount, double face_width);

  protected:
    double amount_, face_width_;
  };

  /// h (2 z / b)^2: barrelling along the face width.
  class LeadCrown : public OverFaceWidth
  {
  public:
    using OverFaceWidth::OverFaceWidth;
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;
  };

  /// a z / b: more is removed towards +z if a > 0; nothing at mid-face.
  class HelixSlope : public OverFaceWidth
  {
  public:
    using OverFaceWidth::OverFaceWidth;
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;
  };

  /// a s^n with s = 1 at the face end and 0 at `length` from it. end: -1, +1 (sign of z), 0: both.
  class EndRelief : public FlankModification
  {
  public:
    EndRelief(double amount, double length, double face_width, int end, ReliefForm form);
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    Turn turn() const override;
    double beyond_start(double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;

  private:
    bool ends_meet() const; ///< reliefs of both ends, with a crest between them

    double amount_, length_, face_width_;
    int end_;
    ReliefForm form_;
  };

  /// Three-dimensional modification of one corner (Wagaj and Kahraman 2002): b max(0, u - v)^n, u = (roll -
  /// start)/(end - start) towards the tip (corners 1, 2) or the start of active profile (3, 4), v = distance
  /// from the corner's face end over `length`: the line u = v runs from (start, face end) to (end, `length`).
  class CornerBias : public FlankModification
  {
  public:
    /// face_end: -1 or +1, sign of the z of the corner's face end (user's axis).
    CornerBias(int corner, double amount, double start_roll, double end_roll, double length,
               double face_width, int face_end, ReliefForm form, double base_radius);
    double removed(double roll, double z) const override;
    double derivative(Parameter by, double roll, double z) const override;
    Turn turn() const override;
    double beyond_start(double roll, double z) const override;
    std::shared_ptr<const FlankModification> with(Parameter by, double value) const override;
    std::string describe(double base_radius) const override;

  private:
    double along_profile() const; ///< of u along the flank, where the relief starts [1/mm]
    double half_blend() const;

    int corner_;
    double amount_, start_, end_, length_, face_width_, base_radius_;
    int face_end_;
    ReliefForm form_;
  };

  /// Sum over all modifications. [mm]
  double removed(const FlankModifications &modifications, double roll, double z);
} // namespace flank
