// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/libraries/module.hpp"

#include "mesh/base/errors.hpp"

#include <deal.II/base/data_out_base.h>

#include <fstream>
#include <functional>
#include <sstream>

namespace flank
{
  namespace
  {
    using Ranges = std::vector<std::tuple<unsigned int, unsigned int, std::string,
                                          dealii::DataComponentInterpretation::DataComponentInterpretation>>;

    struct Names
    {
      explicit Names(const std::vector<FieldPiece::Array> &arrays)
      {
        namespace Interpretation = dealii::DataComponentInterpretation;
        for (const FieldPiece::Array &array : arrays)
          {
            const auto first = static_cast<unsigned int>(components.size());
            for (int c = 0; c < array.components; ++c)
              components.push_back(array.components == 1 ? array.name : array.name + "_" + std::to_string(c));
            if (array.components > 1)
              ranges.emplace_back(first, components.size() - 1, array.name,
                                  array.components == 3 ? Interpretation::component_is_part_of_vector
                                                        : Interpretation::component_is_part_of_tensor);
          }
      }
      std::vector<std::string> components;
      Ranges ranges;
    };

    std::ofstream opened(const std::string &path)
    {
      std::ofstream stream(path);
      if (!stream)
        throw OutputError("cannot write " + path);
      return stream;
    }

    void finish(std::ofstream &stream, const std::string &path)
    {
      stream.close();
      if (!stream)
        throw OutputError("cannot write " + path + " to its end: is the disk full?");
    }

    /// Writes what deal.II makes, without its comment that tells the time.
    void write_record(const std::string &path, const std::function<void(std::ostream &)> &make)
    {
      std::ostringstream record;
      make(record);
      std::string text = record.str();
      if (const auto start = text.find("<!--"), end = text.find("-->");
          start != std::string::npos && end != std::string::npos)
        text.erase(start, end + 4 - start);
      std::ofstream stream = opened(path);
      stream << text;
      finish(stream, path);
    }

    template <int dim>
    void write_cells(std::ostream &stream, const FieldPiece &piece)
    {
      const Names names(piece.arrays);
      const auto n_values = static_cast<Eigen::Index>(names.components.size());
      std::vector<dealii::DataOutBase::Patch<dim, 3>> patches(piece.cells.size());
      for (std::size_t c = 0; c < patches.size(); ++c)
        {
          const Eigen::MatrixXd &cell = piece.cells[c];
          auto &patch = patches[c];
          FLANK_ASSERT(cell.rows() == 3 + n_values, "positions and all arrays");
          patch.patch_index = static_cast<unsigned int>(c);
          patch.n_subdivisions = static_cast<unsigned int>(piece.degree);
          patch.reference_cell = dealii::ReferenceCells::get_hypercube<dim>();
          patch.points_are_available = true;
          patch.data.reinit(static_cast<std::size_t>(n_values + 3), static_cast<std::size_t>(cell.cols()));
          for (Eigen::Index q = 0; q < cell.cols(); ++q)
            {
              for (Eigen::Index v = 0; v < n_values; ++v)
                patch.data(v, q) = static_cast<float>(cell(3 + v, q));
              for (Eigen::Index d = 0; d < 3; ++d)
                patch.data(n_values + d, q) = static_cast<float>(cell(d, q));
            }
        }
      dealii::DataOutBase::VtkFlags flags;
      flags.write_higher_order_cells = piece.degree > 1;
      flags.print_date_and_time = false;
      flags.compression_level = dealii::DataOutBase::VtkFlags::best_speed;
      dealii::DataOutBase::write_vtu(patches, names.components, names.ranges, flags, stream);
    }
  } // namespace

  void dealii_write_vtu(const std::string &path, const FieldPiece &piece)
  {
    std::ofstream stream = opened(path);
    if (piece.dimension == 3)
      write_cells<3>(stream, piece);
    else
      write_cells<2>(stream, piece);
    finish(stream, path);
  }

  void dealii_write_pvtu(const std::string &path, const std::vector<FieldPiece::Array> &arrays,
                         const std::vector<std::string> &pieces)
  {
    const Names names(arrays);
    write_record(path, [&](std::ostream &stream) {
      dealii::DataOutBase::write_pvtu_record(stream, pieces, names.components, names.ranges, {});
    });
  }

  void dealii_write_pvd(const std::string &path, const std::vector<std::pair<double, std::string>> &files)
  {
    write_record(path, [&](std::ostream &stream) { dealii::DataOutBase::write_pvd_record(stream, files); });
  }
} // namespace flank
