// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/body_store.hpp"

#include "cases/work/packing.hpp"
#include "cases/work/versions.hpp"
#include "contact/matching/body_size.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace flank
{
  namespace
  {
    std::vector<char> pack(const BodyCompliance &body)
    {
      Packer out;
      const FlankCompliance &far = body.far_field();
      const FlankSurface &s = far.surface;
      for (const int value : { s.degree, s.rows, s.layers, body.n_unknowns() })
        out.value(value);
      for (const double value : { s.q_tip, s.q_form, s.face_width })
        out.value(value);
      out.values(s.abscissas);
      out.value(static_cast<int>(far.by_tooth_offset.size()));
      for (const auto &matrix : far.by_tooth_offset)
        out.matrix(matrix);
      out.value(static_cast<int>(far.by_depth.size()));
      for (std::size_t d = 0; d < far.by_depth.size(); ++d)
        {
          out.matrix(far.by_depth[d]);
          out.matrix(far.depth_positions[d]);
        }
      const ProjectedSplit::Tables tables =
          body.projected() ? body.projected()->tables() : ProjectedSplit::Tables{};
      out.value(static_cast<int>(tables.size()));
      for (const auto &[key, table] : tables)
        {
          const auto [a, b, c, d] = key;
          for (const int value :
               { a, b, c, d, table->first_row, table->last_row, table->first_layer, table->last_layer,
                 table->rows_of_nodes, table->layers_of_nodes, table->row.points, table->layer.points })
            out.value(value);
          out.values(table->row.breaks);
          out.values(table->layer.breaks);
          out.matrix(table->load_response);
          out.matrix(table->source_response);
        }
      return std::move(out.result);
    }

    /// Throws UnusableRecord.
    void require(const bool holds, const char *what)
    {
      if (!holds)
        throw UnusableRecord(what);
    }

    void require_finite(const Eigen::Ref<const Eigen::MatrixXd> &matrix, const char *what)
    {
      require(matrix.allFinite(), what);
    }

    /// What an elastic response is: finite numbers, of which no two neighbours are nothing, as bytes that
    /// were lost are.
    void require_response(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
    {
      require_finite(matrix, "it holds numbers that are none");
      const auto nothing = (matrix.array() == 0).cast<int>().eval();
      const Eigen::Index rows = matrix.rows();
      require(rows < 2 || !(nothing.topRows(rows - 1) * nothing.bottomRows(rows - 1)).any(),
              "it holds places that do not yield");
    }

    /// The response of a block to its loads: symmetric, and nothing on the nodes of its cut alone.
    void require_response_of_block(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
    {
      require_finite(matrix, "it holds numbers that are none");
      require((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * matrix.cwiseAbs().maxCoeff(),
              "its tables have no elastic energy: they are not symmetric");
      const Eigen::VectorXd held = (matrix.diagonal().array() == 0).cast<double>();
      const double free = static_cast<double>(matrix.rows()) - held.sum();
      require(free > 0 && matrix.diagonal().minCoeff() >= 0 &&
                  static_cast<double>((matrix.array() != 0).count()) == free * free,
              "its tables hold places that do not yield");
    }

    /// Some nodes of every tooth, loaded together, must take work, and every tooth yields.
    void require_energy_of_teeth(const FlankCompliance &far)
    {
      constexpr Eigen::Index most = 40; // nodes of a tooth
      const Eigen::Index nodes = far.surface.n_nodes(), step = std::max<Eigen::Index>(1, nodes / most),
                         count = (nodes + step - 1) / step;
      const auto teeth = static_cast<Eigen::Index>(far.by_tooth_offset.size());
      Eigen::MatrixXd all(teeth * count, teeth * count);
      for (Eigen::Index row = 0; row < teeth; ++row)
        for (Eigen::Index column = 0; column <= row; ++column)
          {
            const auto &of_offset = far.by_tooth_offset[static_cast<std::size_t>(row - column)];
            require(row == column || (of_offset.array() != 0).any(), "its other teeth do not yield");
            for (Eigen::Index i = 0; i < count; ++i)
              for (Eigen::Index j = 0; j < count; ++j)
                all(row * count + i, column * count + j) = of_offset(i * step, j * step);
          }
      require(Eigen::LLT<Eigen::MatrixXd>(all).info() == Eigen::Success,
              "its teeth have no elastic energy together");
    }

    /// That what was stored can be the operator of such a body: sizes that fit each other and the request,
    /// finite numbers, a flank that yields to its own load. Throws UnusableRecord.
    void require_sense(const BodyDefinition &request, const FlankCompliance &far, const int n_unknowns)
    {
      const FlankSurface &s = far.surface;
      require(s.degree == request.resolution.degree && s.rows == request.resolution.flank_rows &&
                  s.layers == request.resolution.face_layers && n_unknowns > 0,
              "it is of another mesh");
      const Gear &gear = request.gear;
      for (const auto &[stored, of_gear] : { std::pair{ s.q_tip, gear.tip_roll * gear.tip_roll },
                                             { s.q_form, gear.form_roll * gear.form_roll },
                                             { s.face_width, gear.face_width } })
        require(std::abs(stored - of_gear) <= 1e-9 * of_gear, "its flank is another one");
      require(s.abscissas == lobatto_abscissas(s.degree), "its nodes are no nodes");
      require(static_cast<int>(far.by_tooth_offset.size()) > request.max_offset, "it is of fewer teeth");
      const Eigen::Index nodes = s.n_nodes();
      for (const auto &matrix : far.by_tooth_offset)
        {
          require(matrix.rows() == nodes && matrix.cols() == nodes, "its matrices are of another size");
          require_finite(matrix, "it holds numbers that are none");
        }
      const auto &own = far.by_tooth_offset.front();
      const double greatest = own.cwiseAbs().maxCoeff();
      require(own.diagonal().minCoeff() > 0, "its flank does not yield to its load");
      // A tooth yields by some tens of force over modulus and face width, whatever it is of.
      const double yields = own.diagonal().maxCoeff() * gear.youngs_modulus * gear.face_width;
      require(yields > 1e-2 && yields < 1e6, "it is of another stiffness");
      require((own - own.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * greatest,
              "it has no elastic energy: it is not symmetric");
      require(Eigen::LLT<Eigen::MatrixXd>(own).info() == Eigen::Success,
              "it has no elastic energy: some loads would give work");
      if (request.model.kind == BodyModel::Kind::ring) // a segment is another body for each tooth
        require_energy_of_teeth(far);
      const NearField &near = request.near_field;
      require(far.by_depth.size() ==
                  (near.split == Split::projected ? 0u : depth_planes(near.depth, s.degree) + 1u),
              "it is of other depths");
      for (std::size_t d = 0; d < far.by_depth.size(); ++d)
        {
          require(far.by_depth[d].rows() == nodes && far.by_depth[d].cols() == nodes &&
                      far.depth_positions[d].cols() == nodes,
                  "its matrices are of another size");
          require_response(far.by_depth[d]);
          require_finite(far.depth_positions[d], "it holds numbers that are none");
        }
    }

    /// Throws unless a table is that of a block around loaded elements: it reaches beyond them, where the
    /// flank does.
    void require_sense(const SectorResolution &mesh, const ProjectedSplit::Key &loaded,
                       const SourceTable &table)
    {
      const auto [first_row, last_row, first_layer, last_layer] = loaded;
      const int rows = mesh.flank_rows, layers = mesh.face_layers, p = mesh.degree;
      require(first_row >= 0 && first_row <= last_row && last_row < rows && first_layer >= 0 &&
                  first_layer <= last_layer && last_layer < layers && table.first_row >= 0 &&
                  table.first_row <= std::max(0, first_row - 1) &&
                  table.last_row >= std::min(rows - 1, last_row + 1) &&
                  table.last_row <= last_row + block_rings && table.first_layer >= 0 &&
                  table.first_layer <= std::max(0, first_layer - 1) &&
                  table.last_layer >= std::min(layers - 1, last_layer + 1) && table.last_layer < layers &&
                  table.rows_of_nodes == (std::min(table.last_row, rows - 1) - table.first_row + 1) * p + 1 &&
                  table.layers_of_nodes == (table.last_layer - table.first_layer + 1) * p + 1,
              "its tables are of other elements");
      const Eigen::Index nodes = static_cast<Eigen::Index>(table.rows_of_nodes) * table.layers_of_nodes;
      require(table.load_response.rows() == nodes && table.load_response.cols() == nodes &&
                  table.source_response.rows() == nodes &&
                  table.source_response.cols() ==
                      static_cast<Eigen::Index>(table.row.size()) * table.layer.size(),
              "its tables are of another size");
      require_response_of_block(table.load_response);
      require_response(table.source_response);
    }

    /// A block that is held at its cut yields less than the body it is a part of, and less under sources than
    /// the body does under a force.
    void require_part_of(const FlankCompliance &far, const SourceTable &table)
    {
      const FlankSurface &surface = far.surface;
      const auto &body = far.by_tooth_offset.front();
      double greatest = 0; // share of the body's
      for (int layer = 0; layer < table.layers_of_nodes; ++layer)
        for (int row = 0; row < table.rows_of_nodes; ++row)
          {
            const int in_block = table.node(row, layer),
                      in_body = surface.node(table.first_row * surface.degree + row,
                                             table.first_layer * surface.degree + layer);
            greatest = std::max(greatest, table.load_response(in_block, in_block) / body(in_body, in_body));
          }
      require(greatest <= 1 + 1e-6 &&
                  table.source_response.cwiseAbs().maxCoeff() <= body.diagonal().maxCoeff(),
              "its tables are of another body");
    }

    PiecewisePolynomial read_axis(Unpacker &in, const int points)
    {
      std::vector<double> breaks = in.values<double>();
      require(
          points >= 2 && points <= PiecewisePolynomial::max_points && breaks.size() >= 2 &&
              std::all_of(breaks.begin(), breaks.end(), [](const double at) { return std::isfinite(at); }) &&
              std::is_sorted(breaks.begin(), breaks.end(), std::less_equal<>()),
          "its tables are of other places");
      return { std::move(breaks), points };
    }
  } // namespace

  std::shared_ptr<const BodyCompliance> unpack_operator(const BodyDefinition &request, SharedBytes payload)
  {
    Unpacker in(std::move(payload));
    FlankCompliance far;
    FlankSurface &s = far.surface;
    for (int *value : { &s.degree, &s.rows, &s.layers })
      *value = in.value<int>();
    const int n_unknowns = in.value<int>();
    for (double *value : { &s.q_tip, &s.q_form, &s.face_width })
      *value = in.value<double>();
    s.abscissas = in.values<double>();
    for (int n = in.value<int>(); n > 0; --n)
      far.by_tooth_offset.push_back(in.matrix());
    for (int n = in.value<int>(); n > 0; --n)
      {
        far.by_depth.push_back(in.matrix());
        const SharedMatrix positions = in.matrix();
        require(positions.rows() == 3, "its places are no places");
        far.depth_positions.emplace_back(positions);
      }
    require_sense(request, far, n_unknowns);
    ProjectedSplit::Tables tables;
    for (int n = in.value<int>(); n > 0; --n)
      {
        std::array<int, 12> numbers{};
        for (int &value : numbers)
          value = in.value<int>();
        auto table = std::make_shared<SourceTable>();
        std::tie(table->first_row, table->last_row, table->first_layer, table->last_layer,
                 table->rows_of_nodes, table->layers_of_nodes) =
            std::tuple(numbers[4], numbers[5], numbers[6], numbers[7], numbers[8], numbers[9]);
        table->row = read_axis(in, numbers[10]);
        table->layer = read_axis(in, numbers[11]);
        table->load_response = in.matrix();
        table->source_response = in.matrix();
        const ProjectedSplit::Key loaded{ numbers[0], numbers[1], numbers[2], numbers[3] };
        require_sense(request.resolution, loaded, *table);
        require_part_of(far, *table);
        tables.emplace(loaded, std::move(table));
      }
    require(in.at_end(), "it holds more than an operator");
    return std::make_shared<const BodyCompliance>(request.gear, request.resolution, request.near_field,
                                                  std::move(far), n_unknowns, std::move(tables));
  }

  double operator_gigabytes(const BodyDefinition &request)
  {
    const BodySize size = size_of(request.resolution);
    return 1e-9 * 8 *
           (size.flank * size.flank * (request.max_offset + 1) +
            6.4e4 * std::pow(5 * request.resolution.degree + 1, 2));
  }

  std::string operator_key(const BodyDefinition &body)
  {
    return operator_sources() + "\n" + identity(body);
  }

  namespace
  {
    /// A cached operator, looked at before anybody relies on it; one that is of no use is forgotten, with a
    /// word.
    std::optional<std::vector<char>> usable_operator(const BodyDefinition &body, const std::string &key,
                                                     const OperatorCache &cache)
    {
      auto payload = cache.load(key);
      if (!payload)
        return std::nullopt;
      try
        {
          unpack_operator(body, { std::shared_ptr<const void>(payload->data(), [](const void *) {}),
                                  payload->data(), payload->size() });
          return std::move(*payload);
        }
      catch (const UnusableRecord &error)
        {
          cache.forget(key, error.what());
          return std::nullopt;
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
                     std::vector<std::vector<char>> images, const ParallelSession &session,
                     std::vector<std::shared_ptr<const BodyCompliance>> &bodies, StageClock &clock)
    {
      for (std::size_t i = 0; i < requests.size(); ++i)
        {
          clock.part = name_of(requests, i);
          bodies[i] = unpack_operator(requests[i], session.share(std::move(images[i]), owner[i]));
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

    /// What one rank holds of a body before all have it: its packed operator, the reduced body, or neither,
    /// where another rank makes it or it could not be made.
    struct OwnBody
    {
      std::vector<char> image;
      std::shared_ptr<const BodyCompliance> body;
    };

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
      std::vector<char> cached = { 0 };
      if (own)
        if (auto payload = usable_operator(request, key, cache))
          {
            result.image = std::move(*payload);
            cached = { 1 };
          }
      if (together && shared)
        session->broadcast(cached);
      if (!cached[0] && (own || together))
        try
          {
            result.body =
                std::make_shared<const BodyCompliance>(request.gear, request.resolution, request.max_offset,
                                                       request.near_field, request.model, session, &clock);
          }
        catch (const std::exception &error) // wrong input for a mesh, a computation, too little memory
          {
            if (!failure || (together && shared)) // the other ranks wait inside for this one
              throw;
            *failure = error.what();
          }
      if (!cached[0] && own && result.body)
        {
          if (!cache.folder().empty() || shared)
            result.image = pack(*result.body);
          cache.store(key, result.image);
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
    std::vector<std::vector<char>> images(requests.size());
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
    else
      for (std::size_t i = 0; i < requests.size(); ++i)
        if (!bodies[i])
          bodies[i] = unpack_operator(requests[i], SharedBytes(std::move(images[i])));
    clock.part.clear();
    return bodies;
  }
} // namespace flank
