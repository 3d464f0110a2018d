// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/position_work.hpp"

#include "cases/packing.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <atomic>

namespace flank
{
  PositionWork::PositionWork(const ParallelSession *session, Journal *journal)
      : session_(session)
      , journal_(journal)
  {
  }

  bool PositionWork::is_root() const
  {
    return !session_ || session_->rank() == 0;
  }

  std::vector<std::vector<char>> PositionWork::run(const int stage, const int count, const std::function<std::vector<char>(int)> &job,
                                                   const std::function<void(int, int)> &done) const
  {
    const auto piece = [&](const int i) { return static_cast<std::uint64_t>(stage) << 40 | static_cast<std::uint64_t>(i); };
    std::vector<std::vector<char>> results(count);
    std::vector<int>               left; // the same list on every rank: all read the same journals
    for (int i = 0; i < count; ++i)
      if (auto found = journal_ ? journal_->find(piece(i)) : std::nullopt)
        results[i] = std::move(*found);
      else
        left.push_back(i);
    const int        ranks = session_ ? session_->ranks() : 1, rank = session_ ? session_->rank() : 0;
    std::vector<int> mine;
    for (std::size_t k = rank; k < left.size(); k += ranks)
      mine.push_back(left[k]);
    std::atomic<int> finished{ 0 };
    parallel_for(static_cast<int>(mine.size()), [&](const int k) {
      results[mine[k]] = job(mine[k]);
      if (journal_)
        journal_->append(piece(mine[k]), results[mine[k]]);
      done(++finished, static_cast<int>(mine.size()));
    });
    if (ranks == 1)
      return results;
    Packer own;
    for (const int i : mine)
      {
        own.value(i);
        own.values(results[i]);
      }
    const auto all = session_->gather(own.result);
    if (rank != 0)
      return {};
    for (const auto &of_rank : all)
      for (Unpacker in(of_rank); !in.at_end();)
        {
          const int i = in.value<int>();
          results[i]  = in.values<char>();
        }
    return results;
  }
} // namespace flank
