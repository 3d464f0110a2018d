// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/edge_field_on_demand.hpp"

#include <map>
#include <utility>

namespace flank::wedge
{
  EdgeFieldOnDemand::EdgeFieldOnDemand(const double opening, const double poissons_ratio)
      : opening_(opening)
      , poissons_ratio_(poissons_ratio)
  {
  }

  const EdgeField &EdgeFieldOnDemand::field()
  {
    std::call_once(once_, [&] { field_.emplace(opening_, poissons_ratio_); });
    return *field_;
  }

  std::shared_ptr<EdgeFieldOnDemand> edge_field_on_demand(const double opening, const double poissons_ratio)
  {
    static std::mutex mutex;
    static std::map<std::pair<double, double>, std::weak_ptr<EdgeFieldOnDemand>> held;
    const std::lock_guard lock(mutex);
    std::weak_ptr<EdgeFieldOnDemand> &of_these = held[{ opening, poissons_ratio }];
    std::shared_ptr<EdgeFieldOnDemand> result = of_these.lock();
    if (!result)
      of_these = result = std::make_shared<EdgeFieldOnDemand>(opening, poissons_ratio);
    return result;
  }
} // namespace flank::wedge
