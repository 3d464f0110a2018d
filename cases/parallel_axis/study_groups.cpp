// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/study_groups.hpp"

#include "cases/parallel_axis/pair/cost.hpp"
#include "cases/parallel_axis/pair/cycle_measures.hpp"
#include "cases/parallel_axis/study_plan.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/work/body_store.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace flank
{
  namespace
  {
    constexpr double gigabytes_a_stage = 1.0; ///< of operators
  }                                           // namespace

  std::vector<std::string> parameters_of(const ParallelAxisCase &input)
  {
    return input.derivatives ? input.parameters : std::vector<std::string>();
  }

  StudyGroups::StudyGroups(const StudyAxes &axes)
      : frames(static_cast<std::size_t>(axes.n_variants()))
  {
    group(axes, read(axes));
    make_stages();
  }

  std::vector<StudyGroups::Group> StudyGroups::read(const StudyAxes &axes)
  {
    std::vector<Group> own(frames.size());
    constexpr int block = 64;
    parallel_for((static_cast<int>(frames.size()) + block - 1) / block, [&](const int b) {
      for (std::size_t v = static_cast<std::size_t>(b) * block;
           v < std::min(frames.size(), (b + 1UL) * block); ++v)
        try
          {
            const CaseFile file = axes.variant(static_cast<long>(v));
            const ParallelAxisCase input = read_parallel_axis(file);
            VariantFrame frame = frame_of(input);
            frame.parameters = parameters_of(input);
            frames[v] = std::make_shared<const VariantFrame>(std::move(frame));
            own[v] = { .requests = input.bodies(),
                       .keys = {},
                       .variants = {},
                       .positions = input.positions,
                       .cycles = input.cycles,
                       .files = file.files() };
            own[v].cells = input.grid.slices * input.grid.profile_cells;
            for (const BodyDefinition &request : own[v].requests)
              own[v].keys.push_back(operator_key(request));
          }
        catch (const InputError &)
          {
          }
    });
    return own;
  }

  void StudyGroups::group(const StudyAxes &axes, std::vector<Group> own)
  {
    std::vector<std::shared_ptr<const VariantFrame>> distinct;
    std::map<std::string, std::size_t> by_key;
    std::set<std::pair<std::size_t, int>> grids; // of which group, of so many cells
    for (std::size_t v = 0; v < frames.size(); ++v)
      if (frames[v])
        {
          const auto same = std::find_if(distinct.begin(), distinct.end(),
                                         [&](const auto &frame) { return *frame == *frames[v]; });
          if (same == distinct.end())
            distinct.push_back(frames[v]);
          else
            frames[v] = *same;
          files.insert(own[v].files.begin(), own[v].files.end());
          std::string key = fmt::format("{} {}\n", own[v].positions, own[v].cycles);
          const int cells = own[v].cells;
          for (const std::string &of_body : own[v].keys)
            key += of_body;
          const auto [at, is_new] = by_key.try_emplace(key, groups.size());
          if (is_new)
            groups.push_back(std::move(own[v]));
          groups[at->second].variants.push_back(static_cast<long>(v));
          if (grids.emplace(at->second, cells).second)
            contact_bytes = std::max(
                contact_bytes, flank::contact_bytes(read_parallel_axis(axes.variant(static_cast<long>(v)))));
        }
  }

  void StudyGroups::make_stages()
  {
    double gigabytes = 0;
    for (const Group &group : groups)
      {
        double needed = 0;
        for (const BodyDefinition &request : group.requests)
          needed += operator_gigabytes(request);
        if (stages.empty() || gigabytes + needed > gigabytes_a_stage)
          {
            stages.emplace_back();
            gigabytes = 0;
          }
        Stage &stage = stages.back();
        for (std::size_t r = 0; r < group.requests.size(); ++r)
          if (std::find(stage.keys.begin(), stage.keys.end(), group.keys[r]) == stage.keys.end())
            {
              stage.requests.push_back(group.requests[r]);
              stage.keys.push_back(group.keys[r]);
              gigabytes += operator_gigabytes(group.requests[r]);
            }
        for (std::size_t from = 0; from < group.variants.size(); from += variants_a_piece)
          for (int position = 0; position < group.positions; ++position)
            {
              StudyPiece piece;
              for (std::size_t k = from; k < std::min(group.variants.size(), from + variants_a_piece); ++k)
                piece.variants.push_back(group.variants[k]);
              for (int cycle = 0; cycle < group.cycles; ++cycle)
                piece.positions.push_back(cycle * group.positions + position);
              stage.pieces.push_back(std::move(piece));
            }
      }
  }
} // namespace flank
