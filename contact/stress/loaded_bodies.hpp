// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/body_compliance.hpp"
#include "contact/stress/contact_region.hpp"
#include "solver/fields/fillet_stress.hpp"
#include "solver/fields/loaded_teeth.hpp"

#include <memory>
#include <vector>

namespace flank
{
  /// The bodies of a case with their insides, which are condensed and factored when something first asks:
  /// once for fields and root stress.
  class LoadedBodies
  {
  public:
    using Bodies = std::vector<std::shared_ptr<const BodyCompliance>>;

    /// The pinion, then the gear where it is another body.
    LoadedBodies(Bodies bodies, const BodyModel &model)
        : bodies_(std::move(bodies))
        , model_(model)
        , inside_(bodies_.size())
        , region_(bodies_.size())
        , fillets_(bodies_.size())
    {
    }

    const Bodies &bodies() const { return bodies_; }
    std::size_t of(const Side side) const
    {
      return side == Side::pinion ? 0 : bodies_.size() - 1;
    } ///< number of the body on that side

    /// The inside of a body, by its number. Throws ComputationError.
    const LoadedTeeth &inside(const std::size_t body)
    {
      if (!inside_[body])
        inside_[body] = std::make_unique<LoadedTeeth>(bodies_[body]->elements(), model_);
      return *inside_[body];
    }

    /// The contact region of a body, by its number. Throws ComputationError.
    const ContactRegion &region(const std::size_t body)
    {
      if (!region_[body])
        region_[body] = std::make_unique<ContactRegion>(bodies_[body]->elements());
      return *region_[body];
    }

    /// The root fillets of a body's teeth, by its number. Throws ComputationError.
    const FilletStress &fillets(const std::size_t body)
    {
      if (!fillets_[body])
        fillets_[body] = std::make_unique<FilletStress>(bodies_[body]->elements());
      return *fillets_[body];
    }

  private:
    Bodies bodies_;
    BodyModel model_;
    std::vector<std::unique_ptr<LoadedTeeth>> inside_;
    std::vector<std::unique_ptr<ContactRegion>> region_;
    std::vector<std::unique_ptr<FilletStress>> fillets_;
  };
} // namespace flank
