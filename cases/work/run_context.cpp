// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/run_context.hpp"

#include "cases/work/versions.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace flank
{
  namespace
  {
    /// Throws InputError on all processes where one has read something else than rank 0. Collective.
    void require_same_inputs(const ParallelSession &session, const std::string &inputs)
    {
      if (session.ranks() == 1)
        return;
      std::vector<char> of_root(inputs.begin(), inputs.end());
      session.broadcast(of_root);
      if (session.any(!std::ranges::equal(of_root, inputs)))
        throw InputError("the processes read different inputs: a file was changed while they began, or they "
                         "do not see the same files; start again");
    }
  } // namespace

  std::string RunContext::with_folder(const std::string &inputs, const std::vector<std::string> &input_files,
                                      const std::function<std::string(Journal &)> &compute)
  {
    const bool is_root = session.rank() == 0;
    require_same_inputs(session, inputs);
    // What one rank alone finds out, all of them wait for.
    const bool finished =
        session.any(is_root && folder.begin(inputs, input_files) == ResultFolder::Start::finished);
    if (finished)
      {
        failures = is_root ? folder.failures() : failures;
        std::string all =
            fmt::format("nothing to do: {} holds the finished results of these inputs\n", folder.path());
        for (const std::string &failure : failures)
          all += "failed: " + failure + "\n";
        return all;
      }
    std::vector<char> owner(folder.owner().begin(), folder.owner().end());
    session.broadcast(owner);
    folder.follow({ owner.begin(), owner.end() });
    Journal journal(folder.work(), inputs + program_sources(), [this] { folder.require_not_lost(); });
    journal.process = process + std::to_string(session.rank());
    if (goes_on && is_root)
      {
        journal.reread();
        if (journal.found() > 0)
          spdlog::info("going on: {} of work done before", counted(journal.found(), "piece"));
      }
    try
      {
        return compute(journal);
      }
    catch (const SharedComputationError &)
      {
        if (is_root)
          folder.discard(); // it would fail again
        throw;
      }
    catch (const ComputationError &)
      {
        folder.discard();
        throw;
      }
  }
} // namespace flank
