// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/body_size.hpp"

#include "mesh/base/memory.hpp"
#include "solver/fields/fillet_stress.hpp"

#include <cmath>

namespace flank
{
  double BodySize::gigabytes() const
  {
    return 1e-9 * 10.5 * 8 * kept() * kept();
  }

  BodySize size_of(const SectorResolution &r)
  {
    const double p = r.degree, layers = r.face_layers * p + 1;
    // Tooth and rim sections, node by node; shared nodes are counted once.
    const double columns = r.tooth_columns + 2 * (r.fillet_columns + r.root_land_columns);
    const double nodes = ((r.flank_rows + r.fillet_rows) * p * (r.tooth_columns * p + 1) +
                          (r.rim_layers * p + 1) * (columns * p + 1)) *
                         layers;
    return { 3 * nodes, 2 * 3 * r.rim_layers * p * layers, (r.flank_rows * p + 1) * layers };
  }

  double factor_bytes(const double unknowns, const int degree)
  {
    return (degree > 2 ? 700 : 390) * std::pow(unknowns, 4.0 / 3);
  }

  double fillets_bytes(const SectorResolution &resolution)
  {
    constexpr int p = FilletStress::block_degree, blocks = 2,
                  section_nodes = (FilletBlock::most_along * p + 1) * (FilletBlock::below_surface * p + 1);
    return blocks * factor_bytes(3.0 * section_nodes * (resolution.face_layers * p + 1), p);
  }

  BodyModel::Reduction reduction_of(const BodyModel &model, const SectorResolution &resolution,
                                    const int ranks)
  {
    if (model.reduction != BodyModel::Reduction::automatic)
      return model.reduction;
    return ranks > 1 && 1e9 * size_of(resolution).gigabytes() > machine_memory() / 2
               ? BodyModel::Reduction::distributed
               : BodyModel::Reduction::condensed;
  }
} // namespace flank
