// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/gear/gear_pair.hpp"

#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// One intentional deviation of a flank from the involute helicoid, as material removed along the flank's normal.
  /// A new kind of modification is a new class; nothing in the contact code knows the kinds.
  class FlankModification
  {
  public:
    virtual ~FlankModification() = default;

    /// Material removed at a roll angle [rad] and face position z [mm] (user's axis, 0 at mid-face). [mm]
    virtual double removed(double roll, double z) const = 0;

    /// One line for reports, with units.
    virtual std::string describe() const = 0;
  };

  using FlankModifications = std::vector<std::shared_ptr<const FlankModification>>;

  enum class ReliefShape
  {
    linear,
    quadratic
  };

  /// a s^n with s = (roll - start)/(end - start) beyond `start`, n = 1 or 2. end > start: tip relief; end < start: root relief.
  class ProfileRelief : public FlankModification
  {
  public:
    ProfileRelief(std::string name, double amount, double start_roll, double end_roll, ReliefShape shape);
    double      removed(double roll, double z) const override;
    std::string describe() const override;

  private:
    std::string name_;
    double      amount_, start_, end_;
    ReliefShape shape_;
  };

  /// h (2 z / b)^2.
  class LeadCrown : public FlankModification
  {
  public:
    LeadCrown(double amount, double face_width);
    double      removed(double roll, double z) const override;
    std::string describe() const override;

  private:
    double amount_, face_width_;
  };

  /// Sum over all modifications. [mm]
  double removed(const FlankModifications &modifications, double roll, double z);
} // namespace flank
