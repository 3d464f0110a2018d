// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/operator_sense.hpp"

#include "contact/matching/classical_split.hpp"
#include "contact/matching/near_field.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/gear/tip_edge.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace flank
{
  namespace
  {
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
      for (const auto &of_offset : far.by_tooth_offset)
        require_response(of_offset);
      Eigen::MatrixXd all(teeth * count, teeth * count);
      for (Eigen::Index row = 0; row < teeth; ++row)
        for (Eigen::Index column = 0; column <= row; ++column)
          {
            const auto &of_offset = far.by_tooth_offset[static_cast<std::size_t>(row - column)];
            for (Eigen::Index i = 0; i < count; ++i)
              for (Eigen::Index j = 0; j < count; ++j)
                all(row * count + i, column * count + j) = of_offset(i * step, j * step);
          }
      require(Eigen::LLT<Eigen::MatrixXd>(all).info() == Eigen::Success,
              "its teeth have no elastic energy together");
    }
  } // namespace

  void require(const bool holds, const char *what)
  {
    if (!holds)
      throw UnusableRecord(what);
  }

  void require_sense(const BodyDefinition &request, const FlankCompliance &far, const int n_unknowns)
  {
    const FlankSurface &s = far.surface;
    require(s.degree == request.resolution.degree && s.rows == request.resolution.flank_rows &&
                s.layers == request.resolution.face_layers && n_unknowns > 0,
            "it is of another mesh");
    const Gear &gear = request.gear;
    for (const auto &[stored, of_gear] : { std::pair{ s.q_tip, std::pow(body_tip_roll(gear), 2) },
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
    require((table.source_response.array() != 0).all(), "its tables have holes");
  }

  namespace
  {
    /// Whether values and their neighbours, all positive, differ by less than a quarter.
    bool is_smooth(const Eigen::Ref<const Eigen::MatrixXd> &values,
                   const Eigen::Ref<const Eigen::MatrixXd> &neighbours)
    {
      return ((values - neighbours).array().abs() < 0.25 * values.cwiseMin(neighbours).array()).all();
    }
  } // namespace

  void require_face(const Eigen::Ref<const Eigen::MatrixXd> &displacements,
                    const Eigen::Ref<const Eigen::MatrixXd> &integrals)
  {
    require(displacements.rows() == wedge::FaceTable::rows &&
                displacements.cols() == wedge::FaceTable::columns &&
                integrals.rows() == wedge::FaceTable::rows_of_integrals &&
                integrals.cols() == wedge::FaceTable::columns,
            "its flank's ends are of another size");
    // In units of 1/E, as a force on a half-space yields by about a third of them at distance 1. From a place
    // of a table to the next both change by an eighth, at openings of 40 to 140 degrees.
    for (const auto &values : { displacements, integrals })
      {
        require_finite(values, "it holds numbers that are none");
        require(values.minCoeff() > 0 && values.maxCoeff() > 1e-3 && values.maxCoeff() < 100 &&
                    is_smooth(values.topRows(values.rows() - 1), values.bottomRows(values.rows() - 1)) &&
                    is_smooth(values.leftCols(values.cols() - 1), values.rightCols(values.cols() - 1)),
                "its flank's ends yield as no wedge does");
      }
  }

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
    require(greatest <= 1 + 1e-6 && table.source_response.cwiseAbs().maxCoeff() <= body.diagonal().maxCoeff(),
            "its tables are of another body");
  }
} // namespace flank
