// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/shared_work.hpp"

#include "cases/work/packing.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <utility>

namespace flank
{
  SharedWork::SharedWork(const ParallelSession *session, Journal *journal, std::string whose)
      : session_(session)
      , journal_(journal)
      , whose_(std::move(whose))
  {
  }

  int SharedWork::rank() const
  {
    return session_ ? session_->rank() : 0;
  }

  int SharedWork::ranks() const
  {
    return session_ ? session_->ranks() : 1;
  }

  std::vector<std::vector<char>> SharedWork::gather(const std::vector<char> &bytes) const
  {
    return session_ ? session_->gather(bytes) : std::vector<std::vector<char>>{ bytes };
  }

  void SharedWork::wait() const
  {
    if (session_)
      session_->wait();
  }

  std::vector<std::vector<char>> SharedWork::run(const Jobs &jobs) const
  {
    const int ranks = this->ranks(), rank = this->rank();
    std::vector<std::vector<char>> results(jobs.count);
    std::vector<char> done_before(jobs.count, 0);
    const auto name = [&](const int job) { return whose_ + jobs.name(job); };
    if (rank == 0 && journal_)
      for (int i = 0; i < jobs.count; ++i)
        while (auto found = journal_->find(name(i)))
          {
            done_before[i] = jobs.sound(i, *found);
            if (done_before[i])
              {
                results[i] = std::move(*found);
                break;
              }
            journal_->reject(name(i));
          }
    if (ranks > 1)
      session_->broadcast(done_before); // one list for all: that of rank 0, which alone reads journals
    std::vector<int> mine;
    for (int i = 0, k = 0; i < jobs.count; ++i)
      if (!done_before[i] && k++ % ranks == rank)
        mine.push_back(i);
    std::atomic<int> finished{ 0 };
    parallel_for(static_cast<int>(mine.size()), [&](const int k) {
      results[mine[k]] = jobs.run(mine[k]);
      if (journal_)
        journal_->append(name(mine[k]), results[mine[k]]);
      jobs.done(++finished, static_cast<int>(mine.size()));
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
          results[i] = in.values<char>();
        }
    return results;
  }
} // namespace flank
