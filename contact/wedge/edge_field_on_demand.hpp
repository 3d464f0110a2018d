// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/wedge/edge_field.hpp"

#include <memory>
#include <mutex>
#include <optional>

namespace flank::wedge
{
  /// The field of a wedge, made when it is first asked for. Safe for several threads.
  class EdgeFieldOnDemand
  {
  public:
    /// Angle between both faces, inside the body [rad].
    EdgeFieldOnDemand(double opening, double poissons_ratio);

    const EdgeField &field();

  private:
    double opening_, poissons_ratio_;
    std::once_flag once_;
    std::optional<EdgeField> field_;
  };

  /// One for all who hold wedges of the same opening and material at the same time: the flanks of a pair,
  /// whose ends are alike crosswise, and the coarser bodies of an error estimate beside them. Safe for
  /// several threads.
  std::shared_ptr<EdgeFieldOnDemand> edge_field_on_demand(double opening, double poissons_ratio);
} // namespace flank::wedge
