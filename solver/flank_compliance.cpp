// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/flank_compliance.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/direct_solver.hpp"

#include <complex>
#include <mutex>

namespace flank
{
  double FlankSurface::q_at(const int row_node) const
  {
    const int row = std::min(row_node / degree, rows - 1);
    return q_tip + (q_form - q_tip) * (row + abscissas[row_node - row * degree]) / rows;
  }

  double FlankSurface::z_at(const int layer_node) const
  {
    const int layer = std::min(layer_node / degree, layers - 1);
    return face_width * ((layer + abscissas[layer_node - layer * degree]) / layers - 0.5);
  }

  FlankSurface flank_surface(const ToothSector &sector)
  {
    const Gear &gear = sector.gear;
    return { sector.resolution.degree,
             sector.resolution.flank_rows,
             sector.resolution.face_layers,
             gear.tip_roll * gear.tip_roll,
             gear.form_roll * gear.form_roll,
             gear.face_width,
             lobatto_abscissas(sector.resolution.degree) };
  }

  Eigen::Matrix3Xd flank_normals(const ToothSector &sector, const FlankSurface &surface)
  {
    const InvoluteHelicoid helicoid = sector.gear.flank();
    Eigen::Matrix3Xd       normals(3, surface.n_nodes());
    for (int k = 0; k < surface.n_layer_nodes(); ++k)
      for (int i = 0; i < surface.n_row_nodes(); ++i)
        normals.col(surface.node(i, k)) = helicoid.frame(std::sqrt(std::max(0.0, surface.q_at(i))), surface.z_at(k)).inward;
    return normals;
  }

  std::vector<int> flank_nodes(const ToothSector &sector, const FlankSurface &surface, const ElasticBody &body, const int depth)
  {
    const int p = surface.degree, n = p + 1, column = std::min(depth / p, sector.section.tooth_columns() - 1), across = depth - column * p;
    std::vector<int> nodes(surface.n_nodes(), -1);
    for (int layer = 0; layer < surface.layers; ++layer)
      for (int row = 0; row < surface.rows; ++row)
        {
          const auto &cell = body.cell_nodes(sector.tooth_cell(row, column, layer));
          for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
              nodes[surface.node(row * p + i, layer * p + k)] = cell[(k * n + across) * n + i];
        }
    return nodes;
  }

  std::vector<int> cut_nodes(const ToothSector &sector, const ElasticBody &body, const bool plus_side)
  {
    const int        p = body.degree(), n = p + 1, levels = sector.section.rim_layers(), layers = sector.resolution.face_layers;
    const int        column = plus_side ? 0 : sector.section.rim_columns() - 1, across = plus_side ? 0 : p;
    std::vector<int> nodes(static_cast<std::size_t>(levels * p) * (layers * p + 1), -1);
    for (int layer = 0; layer < layers; ++layer)
      for (int level = 0; level < levels; ++level)
        {
          const auto &cell = body.cell_nodes(sector.rim_cell(column, level, layer));
          for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
              if (level * p + i < levels * p)
                nodes[(layer * p + k) * levels * p + level * p + i] = cell[(k * n + across) * n + i];
        }
    return nodes;
  }

  std::vector<char> bore_unknowns(const ToothSector &sector, const ElasticBody &body)
  {
    std::vector<char> fixed(body.n_unknowns(), 0);
    const int         p = body.degree(), n = p + 1;
    for (int layer = 0; layer < sector.resolution.face_layers; ++layer)
      for (int column = 0; column < sector.section.rim_columns(); ++column)
        {
          const auto &cell = body.cell_nodes(sector.rim_cell(column, sector.section.rim_layers() - 1, layer));
          for (int k = 0; k < n; ++k)
            for (int j = 0; j < n; ++j)
              for (int c = 0; c < 3; ++c)
                fixed[3 * cell[(k * n + j) * n + p] + c] = 1;
        }
    return fixed;
  }

  namespace
  {
    /// Sector condensed to its cuts, with the flank's part solved: displacement of outputs = own f + transfer' u_cut,
    /// equivalent cut forces = -load f, S_cut u_cut = ... (both cuts, plus side first).
    struct CondensedSector
    {
      Eigen::MatrixXd cut;       ///< 2n x 2n [N/mm]
      Eigen::MatrixXd own;       ///< outputs x loads, cuts held [mm/N]
      Eigen::MatrixXd to_cut;    ///< 2n x loads: forces on the cuts' unknowns for unit loads, cuts free to receive them
      Eigen::MatrixXd to_output; ///< outputs x 2n: displacement of outputs for unit cut displacements
    };

    CondensedSector condense_sector(const ToothSector &sector, const ElasticBody &body, const FlankSurface &surface, const int depth_planes)
    {
      const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
      std::vector<int>       kept;
      const auto             keep = [&](const std::vector<int> &nodes) {
        for (const int node : nodes)
          for (int c = 0; c < 3; ++c)
            kept.push_back(3 * node + c);
      };
      keep(cut_nodes(sector, body, true));
      keep(cut_nodes(sector, body, false));
      const Eigen::Index n_cut = static_cast<Eigen::Index>(kept.size()), n_flank = surface.n_nodes();
      for (int d = 0; d <= depth_planes; ++d)
        keep(flank_nodes(sector, surface, body, d));
      const Eigen::Index n_inner = static_cast<Eigen::Index>(kept.size()) - n_cut;

      const Eigen::MatrixXd schur = condense(body.stiffness(), bore_unknowns(sector, body), kept);

      // Outputs: every plane's nodes along the surface normal above them; loads: the surface plane's.
      Eigen::MatrixXd direction = Eigen::MatrixXd::Zero(n_inner, n_flank * (depth_planes + 1));
      for (Eigen::Index i = 0; i < direction.cols(); ++i)
        direction.block<3, 1>(3 * i, i) = normals.col(i % n_flank);

      const Eigen::LLT<Eigen::MatrixXd> inner(schur.bottomRightCorner(n_inner, n_inner));
      if (inner.info() != Eigen::Success)
        throw ComputationError("the condensed flank stiffness is not positive definite");
      const Eigen::MatrixXd half_direction = inner.matrixL().solve(direction),
                            half_coupling  = inner.matrixL().solve(schur.bottomLeftCorner(n_inner, n_cut));
      CondensedSector result;
      result.cut       = schur.topLeftCorner(n_cut, n_cut) - half_coupling.transpose() * half_coupling;
      result.own       = half_direction.transpose() * half_direction.leftCols(n_flank);
      result.to_cut    = -half_coupling.transpose() * half_direction.leftCols(n_flank);
      result.to_output = -half_direction.transpose() * half_coupling;
      return result;
    }
  } // namespace

  FlankCompliance ring_compliance(const ToothSector &sector, const ElasticBody &body, const int max_offset, const int depth_planes)
  {
    const FlankSurface    surface   = flank_surface(sector);
    const CondensedSector condensed = condense_sector(sector, body, surface, depth_planes);
    const Eigen::Index    n = condensed.cut.rows() / 2, n_flank = surface.n_nodes();
    const int             teeth = sector.gear.teeth;
    const double          pitch = sector.gear.pitch_angle();
    FLANK_ASSERT(max_offset >= 0 && 2 * max_offset <= teeth, "offsets within half the ring");

    // In coordinates that turn with its tooth, the plus cut of a tooth moves with the minus cut of the next: u_plus(t) = R(pitch)
    // u_minus(t+1). Harmonic h: u(t) = u_h exp(i h t pitch), so u_plus = exp(i h pitch) R u_minus.
    Eigen::MatrixXd       rotated_to_cut    = condensed.to_cut.topRows(n);
    Eigen::MatrixXd       rotated_to_output = condensed.to_output.leftCols(n);
    Eigen::MatrixXd       plus_plus = condensed.cut.topLeftCorner(n, n), plus_minus = condensed.cut.topRightCorner(n, n);
    const Eigen::Matrix3d back = Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitZ()).toRotationMatrix(); // R'
    for (Eigen::Index i = 0; i < n; i += 3)
      {
        rotated_to_cut.middleRows<3>(i)    = (back * rotated_to_cut.middleRows<3>(i)).eval();
        plus_plus.middleRows<3>(i)         = (back * plus_plus.middleRows<3>(i)).eval();
        plus_minus.middleRows<3>(i)        = (back * plus_minus.middleRows<3>(i)).eval();
        rotated_to_output.middleCols<3>(i) = (rotated_to_output.middleCols<3>(i) * back.transpose()).eval();
      }
    for (Eigen::Index i = 0; i < n; i += 3)
      plus_plus.middleCols<3>(i) = (plus_plus.middleCols<3>(i) * back.transpose()).eval();
    const Eigen::MatrixXd minus_minus = condensed.cut.bottomRightCorner(n, n);

    using Complex                            = std::complex<double>;
    const int                    n_harmonics = teeth / 2 + 1;
    std::vector<Eigen::MatrixXd> sums(max_offset + 1, Eigen::MatrixXd::Zero(n_flank, n_flank));
    std::vector<Eigen::MatrixXd> depth_sums(depth_planes + 1, Eigen::MatrixXd::Zero(depth_planes > 0 ? n_flank : 0, n_flank));
    // Summed in a fixed order whatever thread computed a harmonic, so the result never depends on the threads.
    const int batch = std::max(1, available_threads());
    for (int first = 0; first < n_harmonics; first += batch)
      {
        std::vector<Eigen::MatrixXcd> responses(std::min(batch, n_harmonics - first));
        parallel_for(static_cast<int>(responses.size()), [&](const int b) {
          const Complex    phase  = std::polar(1.0, (first + b) * pitch);
          Eigen::MatrixXcd system = (plus_plus + minus_minus).cast<Complex>();
          system += std::conj(phase) * plus_minus.cast<Complex>() + phase * plus_minus.transpose().cast<Complex>();
          const Eigen::LLT<Eigen::Ref<Eigen::MatrixXcd>> factor(system);
          if (factor.info() != Eigen::Success)
            throw ComputationError("the condensed ring is not positive definite");
          Eigen::MatrixXcd load = std::conj(phase) * rotated_to_cut.cast<Complex>() + condensed.to_cut.bottomRows(n).cast<Complex>();
          factor.matrixL().solveInPlace(load);
          if (depth_planes == 0)
            responses[b] = load.adjoint() * load;
          else
            {
              Eigen::MatrixXcd output = phase * rotated_to_output.cast<Complex>() + condensed.to_output.rightCols(n).cast<Complex>();
              output.adjointInPlace();
              factor.matrixL().solveInPlace(output);
              responses[b] = output.adjoint() * load;
            }
        });
        for (int b = 0; b < static_cast<int>(responses.size()); ++b)
          {
            const int    h      = first + b;
            const double weight = (h == 0 || 2 * h == teeth ? 1.0 : 2.0) / teeth;
            for (int m = 0; m <= max_offset; ++m)
              sums[m] += weight * (std::polar(1.0, h * m * pitch) * responses[b].topRows(n_flank)).real();
            for (int d = 1; d <= depth_planes; ++d)
              depth_sums[d] += weight * responses[b].middleRows(d * n_flank, n_flank).real();
          }
      }

    FlankCompliance result{ surface, {}, {}, {} };
    for (int m = 0; m <= max_offset; ++m)
      result.by_tooth_offset.push_back(m == 0 ? Eigen::MatrixXd(sums[0] + condensed.own.topRows(n_flank)) : sums[m]);
    Eigen::MatrixXd &self = result.by_tooth_offset.front();
    self                  = (0.5 * (self + self.transpose())).eval();
    if (depth_planes > 0)
      for (int d = 0; d <= depth_planes; ++d)
        {
          result.by_depth.push_back(d == 0 ? self : Eigen::MatrixXd(depth_sums[d] + condensed.own.middleRows(d * n_flank, n_flank)));
          Eigen::Matrix3Xd positions(3, n_flank);
          const auto       nodes = flank_nodes(sector, surface, body, d);
          for (Eigen::Index i = 0; i < n_flank; ++i)
            positions.col(i) = body.node_positions()[nodes[i]];
          result.depth_positions.push_back(positions);
        }
    return result;
  }
} // namespace flank
