// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "cases/results/variant.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/study/study_work.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace flank
{
  /// Keys of the loaded flanks' modifications, where derivatives are asked for.
  std::vector<std::string> parameters_of(const ParallelAxisCase &input);

  /// The variants of a study by what they share: bodies, and stages of bodies that fit the memory.
  struct StudyGroups
  {
    /// Variants with the same bodies and positions.
    struct Group
    {
      std::vector<BodyDefinition> requests; ///< one where both bodies are the same
      std::vector<std::string> keys;        ///< of the operators
      std::vector<long> variants;
      int positions = 0, cycles = 0;
      std::vector<std::string> files;
      int cells = 0; ///< of a slice times slices across the face
    };

    struct Stage
    {
      std::vector<BodyDefinition> requests;
      std::vector<std::string> keys;
      std::vector<StudyPiece> pieces;
    };

    StudyGroups() = default;

    /// Reads every variant once, on all threads.
    explicit StudyGroups(const StudyAxes &axes);

    std::vector<std::shared_ptr<const VariantFrame>> frames; ///< of all variants; null where refused
    std::set<std::string> files;
    double contact_bytes = 0; ///< of the contacts on all threads, the most of the first variant with each
                              ///< grid of each group
    std::vector<Group> groups;
    std::vector<Stage> stages;

  private:
    /// Frames of all variants that can be read, and each as a group of its own.
    std::vector<Group> read(const StudyAxes &axes);
    void group(const StudyAxes &axes, std::vector<Group> own); ///< by bodies and positions
    void make_stages(); ///< groups whose operators fit the memory, in pieces
  };
} // namespace flank
