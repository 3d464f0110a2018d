// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/study_plan.hpp"

#include "cases/parallel_axis/pair/cost.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/work/body_store.hpp"
#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace flank
{
  std::string plan_by_axes(const StudyAxes &axes, const int processes, const double table_bytes)
  {
    const auto keys_of = [](const CaseFile &file) {
      std::set<std::string> keys;
      for (const BodyDefinition &request : read_parallel_axis(file).bodies())
        keys.insert(operator_key(request));
      return keys;
    };
    constexpr long most_points = 100; // of an axis
    const auto of_first = axes.of_first_taken(keys_of);
    if (!of_first)
      return "Refused as input: the first thousand variants, if not all\n";
    double bodies = static_cast<double>(of_first->size());
    const auto shape = axes.shape();
    for (std::size_t axis = 0; axis < shape.size(); ++axis)
      {
        std::set<std::set<std::string>> distinct;
        const long points = std::min(shape[axis], most_points);
        for (long k = 0; k < points; ++k)
          try
            {
              distinct.insert(keys_of(axes.variant(axes.variant_on_axis(axis, k * shape[axis] / points))));
            }
          catch (const InputError &)
            {
            }
        bodies *= std::max(1.0, static_cast<double>(distinct.size())) *
                  (distinct.size() > 1 ? static_cast<double>(shape[axis]) / points : 1);
      }
    auto input = axes.of_first_taken(read_parallel_axis);
    input->extras.clear();
    const CostEstimate cost = estimate_cost(*input, processes);
    const double variants = static_cast<double>(axes.n_variants());
    const double contact = cost.contact_seconds * variants *
                           (another_variant + (1 - another_variant) / variants_a_piece),
                 reduction = cost.reduction_seconds * bodies,
                 solutions =
                     variants * input->positions * input->cycles * static_cast<double>(input->torques.size());
    return fmt::format(
        "Will be computed, by a look at each axis alone\n  about {:.3g} distinct {}\n  {:.3g} contact "
        "{}\n"
        "Expected on this machine, {} of {}\n  reduction {} s, contact {} s; {} GB, of "
        "which {} GB "
        "are the tables of all variants\n",
        bodies, noun_for(bodies, "body", "bodies"), solutions, noun_for(solutions, "solution"),
        counted(processes, "process", "processes"), counted(available_threads(), "thread"),
        two_digits(reduction), two_digits(contact), two_digits(cost.gigabytes + 1e-9 * table_bytes),
        two_digits(1e-9 * table_bytes));
  }
} // namespace flank
