// SPDX-License-Identifier: GPL-2.0-or-later
#include "validation/fuzz/operator.hpp"

#include "cases/parallel_axis/whole_case.hpp"
#include "cases/work/operator_cache.hpp"
#include "validation/fuzz/harness.hpp"

#include <algorithm>
#include <fstream>

namespace flank::fuzz
{
  namespace
  {
    const ParallelAxisCase &ready()
    {
      static const ParallelAxisCase input =
          read_parallel_axis(CaseFile::of_text(schema(), content("cases/parallel_axis/helical.toml"),
                                               FLANK_ROOT "/cases/parallel_axis/helical.toml"));
      return input;
    }

    BodyDefinition request(const Split split)
    {
      BodyDefinition request{ ready().pair.pinion, {}, {}, 1, { .split = split, .points = 4 } };
      SectorResolution &r = request.resolution;
      r.degree = 1, r.flank_rows = 2, r.tooth_columns = 2, r.face_layers = 2, r.rim_layers = 1;
      return request;
    }

    /// One patch in the middle of each element of the flank.
    std::vector<Patch> patches(const BodyDefinition &request)
    {
      const Gear &gear = request.gear;
      const int rows = request.resolution.flank_rows, layers = request.resolution.face_layers;
      const double tip = gear.tip_roll * gear.tip_roll, form = gear.form_roll * gear.form_roll,
                   dq = (form - tip) / rows, dz = gear.face_width / layers;
      std::vector<Patch> result;
      for (int row = 0; row < rows; ++row)
        for (int layer = 0; layer < layers; ++layer)
          {
            const double q = tip + dq * (row + 0.5), z = dz * (layer + 0.5) - gear.face_width / 2, a = dq / 8,
                         b = dz / 8;
            result.push_back({ 0,
                               { { q - a, z - b }, { q + a, z - b }, { q + a, z + b }, { q - a, z + b } },
                               std::sqrt(q),
                               z,
                               0.1,
                               b });
          }
      return result;
    }

    /// What the contact asks of a body; only tables that were stored, as making others takes elements.
    void use(const BodyDefinition &request, const BodyCompliance &body)
    {
      if (body.projected())
        for (int row = 0; row < request.resolution.flank_rows; ++row)
          for (int layer = 0; layer < request.resolution.face_layers; ++layer)
            if (!body.projected()->tables().contains({ row, row, layer, layer }))
              return;
      PatchGroup group = body.group(patches(request)), beside = group;
      const auto n = static_cast<Eigen::Index>(group.patches.size());
      Eigen::MatrixXd far = Eigen::MatrixXd::Zero(n, n), near = far, other = far;
      beside.tooth = request.max_offset;
      body.add_far(group, { &group }, { &far });
      body.add_far(group, { &beside }, { &other });
      if (body.is_near(group, group))
        body.add_near(group, group, patch_potentials(group.patches, group.patches, request.gear.flank()),
                      near, nullptr);
    }
  } // namespace

  std::vector<char> small_operator(const Split split)
  {
    const BodyDefinition r = request(split);
    const int rows = r.resolution.flank_rows, layers = r.resolution.face_layers;
    const Eigen::Index nodes = (rows + 1) * (layers + 1);
    // A load moves all nodes, its own most, other teeth's less.
    const Eigen::MatrixXd own =
        Eigen::MatrixXd::Identity(nodes, nodes) * 1e-5 + Eigen::MatrixXd::Constant(nodes, nodes, 1e-7);
    const Gear &gear = r.gear;
    FlankCompliance far;
    far.surface = { .degree = r.resolution.degree,
                    .rows = rows,
                    .layers = layers,
                    .q_tip = gear.tip_roll * gear.tip_roll,
                    .q_form = gear.form_roll * gear.form_roll,
                    .face_width = gear.face_width,
                    .abscissas = { 0, 1 } };
    for (int offset = 0; offset <= r.max_offset; ++offset)
      far.by_tooth_offset.emplace_back(Eigen::MatrixXd(own / (1 + 9 * offset)));
    const bool is_projected = split == Split::projected;
    for (int plane = 0; !is_projected && plane < 2; ++plane)
      {
        far.by_depth.emplace_back(own);
        far.depth_positions.emplace_back(Eigen::Matrix3Xd::Ones(3, nodes));
      }
    const auto around = [](const int element, const int count) {
      return PiecewisePolynomial({ std::max(0.0, element - 0.5), std::min(1.0 * count, element + 1.5) }, 4);
    };
    ProjectedSplit::Tables tables;
    const FlankEdges edges(gear);
    static const FlankEdges::Faces faces = edges.faces();
    for (int row = 0; is_projected && row < rows; ++row)
      for (int layer = 0; layer < layers; ++layer)
        tables[{ row, row, layer, layer }] = std::make_shared<SourceTable>(
            SourceTable{ .first_row = 0,
                         .last_row = rows,
                         .first_layer = 0,
                         .last_layer = layers - 1,
                         .rows_of_nodes = rows + 1,
                         .layers_of_nodes = layers + 1,
                         .free = edges.edges_of({ 0, layers - 1 }, { layer, layer }, row, layers),
                         .load_response = own,
                         .row = around(row, rows),
                         .layer = around(layer, layers),
                         .source_response = Eigen::MatrixXd(Eigen::MatrixXd::Constant(nodes, 16, 1e-6)) });
    return pack_operator(
        { gear, r.resolution, r.near_field, std::move(far), 1000, std::move(tables), &faces });
  }

  std::string take_operator(const std::string_view bytes)
  {
    static const BodyDefinition projected = request(Split::projected), classical = request(Split::classical);
    static const OperatorCache cache(folder());
    const bool from_file = bytes.starts_with('f');
    const BodyDefinition &wanted = bytes.starts_with('c') ? classical : projected;
    SharedBytes payload(std::vector<char>(bytes.begin() + (bytes.empty() ? 0 : 1), bytes.end()));
    if (from_file)
      {
        std::ofstream(cache.path("key"), std::ios::binary)
            .write(payload.data, static_cast<std::streamsize>(payload.size));
        auto loaded = cache.load("key");
        if (!loaded)
          return "nothing of it is used";
        payload = std::move(*loaded);
      }
    return refusal_of([&] { use(wanted, *unpack_operator(wanted, std::move(payload))); });
  }
} // namespace flank::fuzz
