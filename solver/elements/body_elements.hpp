// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/flank_block.hpp"

#include <memory>
#include <mutex>
#include <optional>

namespace flank
{
  /// The finite elements behind a body's operators: one tooth sector, made when something first asks for it.
  /// Safe for several threads.
  class BodyElements
  {
  public:
    BodyElements(const Gear &gear, const SectorResolution &resolution);
    const ToothSector &sector() const;
    const ElasticBody &body() const;
    const FlankBlocks &blocks() const;

  private:
    struct Made
    {
      Made(const Gear &gear, const SectorResolution &resolution);
      ToothSector sector;
      std::unique_ptr<const ElasticBody> body;
      mutable std::once_flag once;
      mutable std::optional<FlankBlocks> blocks;
    };
    const Made &made() const;

    Gear gear_;
    SectorResolution resolution_;
    mutable std::once_flag once_;
    mutable std::unique_ptr<const Made> made_;
  };
} // namespace flank
