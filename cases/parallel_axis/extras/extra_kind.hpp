// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file/case_file.hpp"
#include "cases/parallel_axis/pair/extra.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// A kind of optional output. All that belongs to one, its keys too, stands in one file of this folder.
  struct ExtraKind
  {
    std::string name; ///< Extra::name() of what it makes
    std::vector<Key> keys;
    std::vector<std::string> files; ///< of the result folder
    std::string left_out;           ///< what the plan says where a case does not ask for it

    /// Whether a study has it too, of its first variant: its table is then a CSV file of the study's folder
    /// and a group of study.h5.
    bool in_studies = true;

    /// The extra that a case asks for; null where it asks for none. Reads the kind's keys in any case. Throws
    /// InputError.
    std::function<std::shared_ptr<const Extra>(const CaseFile &, const ParallelAxisCase &)> asked;

    /// The key, if what it asks for with "yes" is of loaded teeth: a case without a load does not have it.
    std::string of_loaded_teeth = {};
  };

  /// Extra::name() of the extras that other sources look for.
  inline constexpr const char *error_estimate_name = "error estimate", *root_stress_name = "root stress";

  bool asks_for_root_stress(const ParallelAxisCase &input);

  /// A kind that a key asks for with "yes" and leaves out with "no". `make`: as ExtraKind::asked, for a case
  /// that asks for it.
  ExtraKind on_request(
      const std::string &name, const std::string &key, const std::string &meaning, const std::string &file,
      const std::string &left_out,
      std::function<std::shared_ptr<const Extra>(const CaseFile &, const ParallelAxisCase &)> make,
      const std::string &fallback = "no");
} // namespace flank
