// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/whole_case.hpp"

#include "cases/parallel_axis/extras/extras.hpp"
#include "cases/parallel_axis/input/input.hpp"
#include "cases/parallel_axis/input/keys.hpp"
#include "mesh/base/errors.hpp"

#include <algorithm>

namespace flank
{
  SceneKeys parallel_axis_keys()
  {
    SceneKeys all = pair_keys();
    for (const ExtraKind &kind : pair_extras())
      all.keys.insert(all.keys.end(), kind.keys.begin(), kind.keys.end());
    return all;
  }

  namespace
  {
    bool is_loaded(const ParallelAxisCase &input)
    {
      return std::ranges::any_of(input.torques, [](const double torque) { return torque > 0; });
    }
  } // namespace

  ParallelAxisCase read_run(const CaseFile &file)
  {
    ParallelAxisCase input = read_parallel_axis(file);
    for (const ExtraKind &kind : pair_extras())
      if (!kind.of_loaded_teeth.empty() && file.text(kind.of_loaded_teeth) == "yes" && !is_loaded(input))
        throw InputError(file.place(kind.of_loaded_teeth) +
                         "needs a loaded pair: every torque of load.pinion_torque_Nm is 0");
    return input;
  }

  ParallelAxisCase read_parallel_axis(const CaseFile &file)
  {
    ParallelAxisCase input = read_pair(file);
    if (input.derivatives)
      file.require_study("output.derivatives", "derivatives are of studies");
    for (const ExtraKind &kind : pair_extras())
      if (auto extra = kind.asked(file, input); extra && (kind.of_loaded_teeth.empty() || is_loaded(input)))
        input.extras.push_back(std::move(extra));
      else
        input.not_asked_for.push_back(kind.left_out);
    file.require_all_used();
    return input;
  }
} // namespace flank
