// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/libraries/module.hpp"
#include "solver/libraries/petsc.hpp"

#include <algorithm>
#include <numeric>

namespace flank
{
  namespace
  {
    /// Where the free unknowns go: interior ones in one range a rank, by the METIS part of a node; kept ones
    /// all on rank 0.
    struct Numbering
    {
      Numbering(const ElasticBody &body, const std::vector<int> &part_of_cell, const std::vector<char> &fixed,
                const std::vector<int> &kept, const int ranks)
          : n_cells(static_cast<int>(part_of_cell.size()))
          , n_kept(static_cast<int>(kept.size()))
          , index(body.n_unknowns(), -1)
          , is_kept(body.n_unknowns(), 0)
          , starts(ranks + 1, 0)
      {
        std::vector<int> owner(body.n_nodes(), ranks);
        for (int cell = 0; cell < static_cast<int>(part_of_cell.size()); ++cell)
          for (const int node : body.cell_nodes(cell))
            owner[node] = std::min(owner[node], part_of_cell[cell]);
        for (std::size_t k = 0; k < kept.size(); ++k)
          {
            is_kept[kept[k]] = 1;
            index[kept[k]] = static_cast<int>(k);
          }
        int next = 0;
        for (int rank = 0; rank < ranks; ++rank)
          {
            starts[rank] = next;
            for (int node = 0; node < body.n_nodes(); ++node)
              if (owner[node] == rank)
                for (int i = 3 * node; i < 3 * node + 3; ++i)
                  if (!fixed[i] && !is_kept[i])
                    index[i] = next++;
          }
        starts[ranks] = next;
      }
      int n_cells, n_kept;
      std::vector<int> index;    ///< of an unknown among the interior or the kept ones; -1: fixed
      std::vector<char> is_kept; ///< a flag an unknown
      std::vector<int> starts;   ///< interior range of each rank
    };

    /// A matrix of this rank's rows with room for as many entries a row as `counts` says, on and off the
    /// rank's columns.
    void create(petsc::Matrix &matrix, const int rows, const int columns, const std::vector<PetscInt> &on,
                const std::vector<PetscInt> &off)
    {
      FLANK_PETSC(MatCreateAIJ(MPI_COMM_WORLD, rows, columns, PETSC_DETERMINE, PETSC_DETERMINE, 0, on.data(),
                               0, off.data(), &matrix.mat));
    }

    /// Entries of each interior row of a rank: with interior unknowns on it and off it, with kept ones (all
    /// on rank 0).
    struct RowEntries
    {
      RowEntries(const ElasticBody &body, const Numbering &numbering, int rank);
      std::vector<PetscInt> on, off, kept_on, kept_off;
    };

    RowEntries::RowEntries(const ElasticBody &body, const Numbering &numbering, const int rank)
    {
      const int first = numbering.starts[rank], last = numbering.starts[rank + 1], n_own = last - first;
      std::vector<std::vector<int>> neighbours(n_own);
      for (int cell = 0; cell < numbering.n_cells; ++cell)
        for (const int a : body.cell_nodes(cell))
          for (int i = 3 * a; i < 3 * a + 3; ++i)
            if (!numbering.is_kept[i] && numbering.index[i] >= first && numbering.index[i] < last)
              neighbours[numbering.index[i] - first].insert(neighbours[numbering.index[i] - first].end(),
                                                            body.cell_nodes(cell).begin(),
                                                            body.cell_nodes(cell).end());
      on.assign(n_own, 0);
      off = kept_on = kept_off = on;
      for (int row = 0; row < n_own; ++row)
        {
          auto &list = neighbours[row];
          std::sort(list.begin(), list.end());
          list.erase(std::unique(list.begin(), list.end()), list.end());
          for (const int b : list)
            for (int j = 3 * b; j < 3 * b + 3; ++j)
              if (numbering.is_kept[j])
                ++(rank == 0 ? kept_on : kept_off)[row];
              else if (numbering.index[j] >= 0)
                ++(numbering.index[j] >= first && numbering.index[j] < last ? on : off)[row];
          std::vector<int>().swap(list);
        }
    }

    void assemble(const petsc::Matrix &matrix)
    {
      FLANK_PETSC(MatAssemblyBegin(matrix.mat, MAT_FINAL_ASSEMBLY));
      FLANK_PETSC(MatAssemblyEnd(matrix.mat, MAT_FINAL_ASSEMBLY));
    }

    std::vector<int> own_cells(const std::vector<int> &part, const int rank)
    {
      std::vector<int> cells;
      for (int cell = 0; cell < static_cast<int>(part.size()); ++cell)
        if (part[cell] == rank)
          cells.push_back(cell);
      return cells;
    }

    /// Adds the stiffness of some cells: between interior unknowns, between them and kept ones, between kept
    /// ones.
    void add_cells(const ElasticBody &body, const NodeAxes &axes, const Numbering &numbering,
                   const std::vector<int> &cells, const petsc::Matrix &interior,
                   const petsc::Matrix &coupling, Eigen::MatrixXd &of_kept)
    {
      Eigen::MatrixXd k;
      body.each_stiffness(cells, [&](const int cell, const Eigen::MatrixXd &of_cell) {
        const auto &nodes = body.cell_nodes(cell);
        k = of_cell;
        turn_into_axes(axes, nodes, k);
        for (Eigen::Index a = 0; a < k.rows(); ++a)
          {
            const int i = 3 * nodes[a / 3] + static_cast<int>(a % 3);
            if (numbering.index[i] < 0)
              continue;
            for (Eigen::Index b = 0; b < k.cols(); ++b)
              {
                const int j = 3 * nodes[b / 3] + static_cast<int>(b % 3);
                if (numbering.index[j] < 0 || (numbering.is_kept[i] && !numbering.is_kept[j]))
                  continue;
                if (numbering.is_kept[i])
                  of_kept(numbering.index[i], numbering.index[j]) += k(a, b);
                else
                  FLANK_PETSC(MatSetValue(numbering.is_kept[j] ? coupling.mat : interior.mat,
                                          numbering.index[i], numbering.index[j], k(a, b), ADD_VALUES));
              }
          }
      });
    }

    /// Less coupling' interior^-1 coupling, a block of right sides at a time.
    void subtract_eliminated(const petsc::Matrix &factor, const petsc::Matrix &coupling,
                             const Numbering &numbering, const int rank, Eigen::MatrixXd &complement)
    {
      const int first = numbering.starts[rank], n_own = numbering.starts[rank + 1] - first,
                n_kept = numbering.n_kept;
      constexpr int block = 128;
      petsc::IndexSet rows;
      FLANK_PETSC(ISCreateStride(MPI_COMM_WORLD, n_own, first, 1, &rows.is));
      for (int at = 0; at < n_kept; at += block)
        {
          const int width = std::min(block, n_kept - at);
          petsc::IndexSet columns;
          FLANK_PETSC(ISCreateStride(MPI_COMM_WORLD, rank == 0 ? width : 0, at, 1, &columns.is));
          petsc::Matrix some, right, solution, product;
          FLANK_PETSC(MatCreateSubMatrix(coupling.mat, rows.is, columns.is, MAT_INITIAL_MATRIX, &some.mat));
          FLANK_PETSC(MatConvert(some.mat, MATDENSE, MAT_INITIAL_MATRIX, &right.mat));
          FLANK_PETSC(MatDuplicate(right.mat, MAT_DO_NOT_COPY_VALUES, &solution.mat));
          FLANK_PETSC(MatMatSolve(factor.mat, right.mat, solution.mat));
          FLANK_PETSC(MatTransposeMatMult(coupling.mat, solution.mat, MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                                          &product.mat));
          if (rank == 0)
            {
              const PetscScalar *data;
              PetscInt stride;
              FLANK_PETSC(MatDenseGetArrayRead(product.mat, &data));
              FLANK_PETSC(MatDenseGetLDA(product.mat, &stride));
              complement.middleCols(at, width) -= Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
                  data, n_kept, width, Eigen::OuterStride<>(stride));
              FLANK_PETSC(MatDenseRestoreArrayRead(product.mat, &data));
            }
        }
    }
  } // namespace

  Eigen::MatrixXd mumps_condense_across_ranks(const ElasticBody &body, const NodeAxes &axes,
                                              const std::vector<char> &fixed, const std::vector<int> &kept,
                                              const int rank, const int ranks, const SumAtRoot &add_to_root)
  {
    const int n_kept = static_cast<int>(kept.size());
    const std::vector<int> part = body.partition(ranks);
    const Numbering numbering(body, part, fixed, kept, ranks);
    const int n_own = numbering.starts[rank + 1] - numbering.starts[rank];
    const int own_kept = rank == 0 ? n_kept : 0;

    const RowEntries entries(body, numbering, rank);
    petsc::Matrix interior, coupling;
    create(interior, n_own, n_own, entries.on, entries.off);
    create(coupling, n_own, own_kept, entries.kept_on, entries.kept_off);
    Eigen::MatrixXd complement =
        Eigen::MatrixXd::Zero(n_kept, n_kept); // of this rank's cells first, summed over the ranks below
    add_cells(body, axes, numbering, own_cells(part, rank), interior, coupling, complement);
    assemble(interior);
    assemble(coupling);
    add_to_root(complement.data(), complement.size());
    if (rank != 0)
      complement.resize(0, 0);
    FLANK_PETSC(MatSetOption(interior.mat, MAT_SPD, PETSC_TRUE));

    petsc::Matrix factor;
    FLANK_PETSC(MatGetFactor(interior.mat, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor.mat));
    FLANK_PETSC(MatMumpsSetIcntl(factor.mat, 14, 40)); // workspace estimate, per cent
    petsc::factor_cholesky(factor.mat, interior.mat);

    subtract_eliminated(factor, coupling, numbering, rank, complement);
    return 0.5 * (complement + complement.transpose());
  }
} // namespace flank
