// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace flank
{
  /// results.h5: the one place that knows HDF5 (the library that deal.II links). Equal contents make equal
  /// files. The library makes the file in memory, and it goes to the disk in one checked piece: a full disk
  /// meets no open HDF5 object. Throws OutputError.
  class Hdf5File
  {
  public:
    Hdf5File();
    ~Hdf5File();

    /// Writes the whole file to a path where nothing is yet. To be called once, at the end.
    void write_to(const std::string &path);

    void attribute(const std::string &name, const std::string &value);

    /// Numbers in row-major order with their unit as attribute "unit"; folder: group, made when new ("" the
    /// root), levels parted by /. `scales`: names of data sets of that group, one a dimension, whose values
    /// number the rows of that dimension (HDF5's dimension scales).
    void dataset(const std::string &folder, const std::string &name, const std::vector<std::size_t> &shape,
                 const std::vector<double> &values, const std::string &unit,
                 const std::vector<std::string> &scales = {});

    /// Whole numbers, which the file keeps as such.
    void dataset(const std::string &folder, const std::string &name, const std::vector<std::size_t> &shape,
                 const std::vector<int> &values, const std::string &unit,
                 const std::vector<std::string> &scales = {});

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace flank
