// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/operator_image.hpp"

#include "cases/work/operator_sense.hpp"
#include "cases/work/packing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace flank
{
  namespace
  {
    /// Responses a plane below the surface, of the classical split, with the places of its nodes.
    struct Plane
    {
      SharedMatrix responses;
      Eigen::Matrix3Xd places;
    };

    /// A table of the near field with the elements it is of.
    struct Table
    {
      ProjectedSplit::Key loaded;
      SourceTable table;
    };

    /// What is stored of an operator.
    struct Image
    {
      FlankSurface surface{};
      int unknowns = 0;
      std::vector<SharedMatrix> by_tooth_offset;
      std::vector<Plane> planes;
      std::vector<Table> tables;
      std::vector<SharedMatrix> faces; ///< of the flank's free edges: both tables of each
    };

    /// The one list of an image's fields.
    template <class Archive, class OwnImage>
    void fields_of_image(Archive &archive, OwnImage &image)
    {
      auto &s = image.surface;
      archive.fields(s.degree, s.rows, s.layers, image.unknowns, s.q_tip, s.q_form, s.face_width,
                     s.abscissas);
      archive.list(image.by_tooth_offset, [](auto &to, auto &matrix) { to.fields(matrix); });
      archive.list(image.planes, [](auto &to, auto &plane) { to.fields(plane.responses, plane.places); });
      archive.list(image.tables, [](auto &to, auto &of_elements) {
        auto &[loaded, t] = of_elements;
        auto &[first_row, last_row, first_layer, last_layer] = loaded;
        to.fields(first_row, last_row, first_layer, last_layer, t.first_row, t.last_row, t.first_layer,
                  t.last_layer, t.rows_of_nodes, t.layers_of_nodes, t.row.points, t.layer.points);
        to.fields(t.row.breaks, t.layer.breaks, t.load_response, t.source_response);
      });
      archive.list(image.faces, [](auto &to, auto &values) { to.fields(values); });
    }

    Image image_of(const BodyCompliance &body)
    {
      const FlankCompliance &far = body.far_field();
      Image image{ .surface = far.surface,
                   .unknowns = body.n_unknowns(),
                   .by_tooth_offset = far.by_tooth_offset,
                   .planes = {},
                   .tables = {},
                   .faces = {} };
      for (std::size_t d = 0; d < far.by_depth.size(); ++d)
        image.planes.push_back({ far.by_depth[d], far.depth_positions[d] });
      if (body.projected())
        for (const auto &[loaded, table] : body.projected()->tables())
          image.tables.push_back({ loaded, *table });
      if (body.projected() && body.projected()->edges().are_free())
        for (const wedge::FaceTable &face : body.projected()->edges().faces())
          image.faces.insert(image.faces.end(), { face.displacements(), face.integrals() });
      return image;
    }

    FlankCompliance far_field_of(const Image &image)
    {
      FlankCompliance far{ .surface = image.surface,
                           .by_tooth_offset = image.by_tooth_offset,
                           .by_depth = {},
                           .depth_positions = {} };
      for (const Plane &plane : image.planes)
        {
          far.by_depth.push_back(plane.responses);
          far.depth_positions.push_back(plane.places);
        }
      return far;
    }

    /// The faces of the flank's free edges. Throws UnusableRecord unless they are what a wedge's face can be.
    std::optional<FlankEdges::Faces> faces_of(const FlankEdges &edges, const NearField &near_field,
                                              const Image &image)
    {
      const bool free = near_field.split == Split::projected && near_field.free_ends;
      const std::size_t count = free ? edges.has_tip() ? 3 : 2 : 0;
      require(image.faces.size() == 2 * count, "it is of other edges of the flank");
      if (!free)
        return {};
      FlankEdges::Faces faces;
      for (std::size_t edge = 0; edge < count; ++edge)
        {
          require_face(image.faces[2 * edge], image.faces[2 * edge + 1]);
          faces.emplace_back(image.faces[2 * edge], image.faces[2 * edge + 1]);
        }
      return faces;
    }

    /// Throws UnusableRecord unless polynomials can lie on such intervals.
    void require_axis(const PiecewisePolynomial &axis)
    {
      const std::vector<double> &breaks = axis.breaks;
      require(
          axis.points >= 2 && axis.points <= PiecewisePolynomial::max_points && breaks.size() >= 2 &&
              std::all_of(breaks.begin(), breaks.end(), [](const double at) { return std::isfinite(at); }) &&
              std::is_sorted(breaks.begin(), breaks.end(), std::less_equal<>()),
          "its tables are of other places");
    }
  } // namespace

  std::vector<char> pack_operator(const BodyCompliance &body)
  {
    const Image image = image_of(body);
    Packer out;
    fields_of_image(out, image);
    return std::move(out.result);
  }

  std::shared_ptr<const BodyCompliance> unpack_operator(const BodyDefinition &request, SharedBytes payload)
  {
    Unpacker in(std::move(payload));
    Image image;
    fields_of_image(in, image);
    require(in.at_end(), "it holds more than an operator");
    FlankCompliance far = far_field_of(image);
    require_sense(request, far, image.unknowns);
    ProjectedSplit::Tables tables;
    const FlankEdges edges(request.gear, request.near_field.free_ends);
    for (Table &stored : image.tables)
      {
        const auto [first_row, last_row, first_layer, last_layer] = stored.loaded;
        stored.table.free = edges.edges_of({ stored.table.first_layer, stored.table.last_layer },
                                           { first_layer, last_layer }, first_row, far.surface.layers);
        require_axis(stored.table.row), require_axis(stored.table.layer);
        require_sense(request.resolution, stored.loaded, stored.table);
        require_part_of(far, stored.table);
        tables.emplace(stored.loaded, std::make_shared<SourceTable>(std::move(stored.table)));
      }
    const auto faces = faces_of(edges, request.near_field, image);
    return std::make_shared<const BodyCompliance>(request.gear, request.resolution, request.near_field,
                                                  std::move(far), image.unknowns, std::move(tables),
                                                  faces ? &*faces : nullptr);
  }
} // namespace flank
