// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/hdf5_file.hpp"

#include <deal.II/base/hdf5.h>

#include <map>

namespace flank
{
  struct Hdf5File::Implementation
  {
    dealii::HDF5::File                         file;
    std::map<std::string, dealii::HDF5::Group> groups;

    dealii::HDF5::Group &group(const std::string &path)
    {
      if (path.empty())
        return file;
      if (const auto it = groups.find(path); it != groups.end())
        return it->second;
      const auto slash  = path.rfind('/');
      auto      &parent = group(slash == std::string::npos ? "" : path.substr(0, slash));
      return groups.emplace(path, parent.create_group(path.substr(slash == std::string::npos ? 0 : slash + 1))).first->second;
    }
  };

  Hdf5File::Hdf5File(const std::string &path)
      : implementation_(std::make_unique<Implementation>(Implementation{ { path, dealii::HDF5::File::FileAccessMode::create }, {} }))
  {
  }

  Hdf5File::~Hdf5File() = default;

  void Hdf5File::attribute(const std::string &name, const std::string &value)
  {
    implementation_->file.set_attribute(name, value);
  }

  void Hdf5File::dataset(const std::string &folder, const std::string &name, const std::vector<std::size_t> &shape,
                         const std::vector<double> &values, const std::string &unit)
  {
    auto dataset = implementation_->group(folder).create_dataset<double>(name, std::vector<hsize_t>(shape.begin(), shape.end()));
    dataset.write(values);
    dataset.set_attribute("unit", unit);
  }
} // namespace flank
