// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/body_store.hpp"

#include "cases/work/operator_image.hpp"
#include "cases/work/operator_sense.hpp"
#include "cases/work/versions.hpp"
#include "contact/matching/body_size.hpp"
#include "mesh/base/errors.hpp"
#include "solver/elements/flank_block.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

namespace flank
{
  namespace
  {
    /// The near field's tables have responses at the nodes on the loaded face of a block to sources at so
    /// many places, those of all tables of a body together. Taken as one number for all levels: stored
    /// operators of three ready cases have 2.1e4 to 2.6e4 at draft, 4.7e4 to 5.8e4 at standard, 9.2e4 at
    /// reference.
    constexpr double places_of_sources = 6.4e4;
  } // namespace

  double operator_gigabytes(const BodyDefinition &request)
  {
    const BodySize size = size_of(request.resolution);
    return 1e-9 * 8 *
           (size.flank * size.flank * (request.max_offset + 1) +
            places_of_sources * std::pow((2 * block_rings + 1) * request.resolution.degree + 1, 2));
  }

  std::string operator_key(const BodyDefinition &body)
  {
    return operator_sources() + "\n" + identity(body);
  }

  namespace
  {
    /// What one rank holds of a body before all have it: the body and its packed operator; neither where
    /// another rank makes it or it could not be made.
    struct OwnBody
    {
      SharedBytes image;
      std::shared_ptr<const BodyCompliance> body;
    };

    /// A body from the cache, where it has one; one that is of no use is forgotten, with a word.
    OwnBody cached_body(const BodyDefinition &body, const std::string &key, const OperatorCache &cache)
    {
      const auto image = cache.load(key);
      if (!image)
        return {};
      try
        {
          return { *image, unpack_operator(body, *image) };
        }
      catch (const UnusableRecord &error)
        {
          cache.forget(key, error.what());
          return {};
        }
    }

    /// A clock's part of one request, where one stands for both bodies or each for its own.
    std::string name_of(const std::vector<BodyDefinition> &requests, const std::size_t i)
    {
      return requests.size() == 1 ? "both bodies: " : requests[i].gear.name + ": ";
    }

    /// Every rank gets what the owners packed: one copy a node, and the owner uses it too, so that all
    /// compute with the same bytes.
    void send_to_all(const std::vector<BodyDefinition> &requests, const std::vector<int> &owner,
                     std::vector<SharedBytes> images, const ParallelSession &session,
                     std::vector<std::shared_ptr<const BodyCompliance>> &bodies, StageClock &clock)
    {
      for (std::size_t i = 0; i < requests.size(); ++i)
        {
          clock.part = name_of(requests, i);
          bodies[i] = unpack_operator(requests[i], session.share(std::exchange(images[i], {}), owner[i]));
          clock.finished(owner[i] == session.rank() ? "sending the operator"
                                                    : fmt::format("operator from rank {}", owner[i]));
        }
    }

    /// Sets each body's way of reduction as the memory of rank 0's node allows, on every rank the same.
    void choose_reductions(std::vector<BodyDefinition> &requests, const ParallelSession *session)
    {
      const int ranks = session ? session->ranks() : 1;
      std::vector<char> reductions;
      for (const BodyDefinition &request : requests)
        reductions.push_back(static_cast<char>(reduction_of(request.model, request.resolution, ranks)));
      if (ranks > 1)
        session->broadcast(reductions);
      for (std::size_t i = 0; i < requests.size(); ++i)
        requests[i].model.reduction = static_cast<BodyModel::Reduction>(reductions[i]);
    }

    /// What the libraries made of a body must be an elastic one, as what a file holds of it. Throws
    /// ComputationError.
    void require_elastic(const BodyDefinition &request, const BodyCompliance &body)
    try
      {
        require_sense(request, body.far_field(), body.n_unknowns());
      }
    catch (const UnusableRecord &error)
      {
        throw ComputationError(
            fmt::format("the reduction of the {} went wrong: {}", request.gear.name, error.what()));
      }

    /// What `make` makes. What goes wrong (wrong input for a mesh, a computation, too little memory) is told
    /// in `failure` where that is given, and nothing is made; else it is thrown, as a library's failure
    /// always is.
    template <class Make>
    auto made_or_told(std::string *failure, const Make &make) -> decltype(make())
    try
      {
        return make();
      }
    catch (const LibraryError &)
      {
        throw;
      }
    catch (const std::exception &error)
      {
        if (!failure)
          throw;
        *failure = error.what();
        return {};
      }

    /// One body from the cache, else reduced now and stored there, by its owner or, where its reduction is
    /// distributed, by all ranks together. `failure` as reduced_bodies() has it.
    OwnBody cached_or_reduced(const BodyDefinition &request, const int owner, const OperatorCache &cache,
                              const ParallelSession *session, StageClock &clock, std::string *failure)
    {
      const bool shared = session && session->ranks() > 1,
                 together = request.model.reduction == BodyModel::Reduction::distributed,
                 own = owner == (session ? session->rank() : 0);
      const std::string key = operator_key(request);
      OwnBody result;
      if (own)
        result = cached_body(request, key, cache);
      std::vector<char> cached = { static_cast<char>(result.body != nullptr) };
      if (together && shared)
        session->broadcast(cached);
      if (!cached[0] && (own || together)) // together: the other ranks wait inside for one that fails
        result.body = made_or_told(together && shared ? nullptr : failure, [&] {
          return std::make_shared<const BodyCompliance>(request.gear, request.resolution, request.max_offset,
                                                        request.near_field, request.model, session, &clock);
        });
      if (!cached[0] && own && result.body)
        result.body = made_or_told(failure, [&] {
          require_elastic(request, *result.body);
          return result.body;
        });
      if (!cached[0] && own && result.body)
        {
          if (!cache.folder().empty() || shared)
            result.image = SharedBytes(pack_operator(*result.body));
          cache.store(key, { result.image.data, result.image.size });
        }
      if (own)
        clock.finished(cached[0] ? "cached operator" : "keeping the operator");
      return result;
    }

    /// Whether a body could not be computed, on any rank: each then says why, or that it was another one.
    bool has_failed(std::string *failure, const ParallelSession *session)
    {
      const bool shared = session && session->ranks() > 1;
      if (!failure || !(shared ? session->any(!failure->empty()) : !failure->empty()))
        return false;
      if (failure->empty())
        *failure = "on another rank";
      return true;
    }
  } // namespace

  std::vector<std::shared_ptr<const BodyCompliance>> reduced_bodies(std::vector<BodyDefinition> requests,
                                                                    const OperatorCache &cache,
                                                                    const ParallelSession *session,
                                                                    StageClock &clock, std::string *failure)
  {
    choose_reductions(requests, session);
    const int ranks = session ? session->ranks() : 1;
    std::vector<std::shared_ptr<const BodyCompliance>> bodies(requests.size());
    std::vector<SharedBytes> images(requests.size());
    std::vector<int> owner(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i)
      {
        const bool together = requests[i].model.reduction == BodyModel::Reduction::distributed;
        owner[i] = together ? 0 : static_cast<int>(i) % ranks;
        clock.part = name_of(requests, i);
        OwnBody own = cached_or_reduced(requests[i], owner[i], cache, session, clock, failure);
        images[i] = std::move(own.image);
        bodies[i] = std::move(own.body);
      }
    if (has_failed(failure, session))
      return {};
    if (ranks > 1)
      send_to_all(requests, owner, std::move(images), *session, bodies, clock);
    clock.part.clear();
    return bodies;
  }
} // namespace flank
