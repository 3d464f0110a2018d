// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/elements/body_elements.hpp"

namespace flank
{
  BodyElements::BodyElements(const Gear &gear, const SectorResolution &resolution)
      : gear_(gear)
      , resolution_(resolution)
  {
  }

  BodyElements::Made::Made(const Gear &gear, const SectorResolution &resolution)
      : sector(make_tooth_sector(gear, resolution))
      , body(make_elastic_body(sector.mesh, resolution.degree, gear.youngs_modulus, gear.poissons_ratio))
  {
  }

  const BodyElements::Made &BodyElements::made() const
  {
    std::call_once(once_, [&] { made_ = std::make_unique<const Made>(gear_, resolution_); });
    return *made_;
  }

  const ToothSector &BodyElements::sector() const
  {
    return made().sector;
  }

  const ElasticBody &BodyElements::body() const
  {
    return *made().body;
  }

  const FlankBlocks &BodyElements::blocks() const
  {
    const Made &m = made();
    std::call_once(m.once, [&] { m.blocks.emplace(m.sector, *m.body); });
    return *m.blocks;
  }
} // namespace flank
