// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/hdf5_file.hpp"

#include "cases/files/checked_file.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

namespace flank
{
  namespace
  {
    hid_t require(const hid_t id)
    {
      if (id < 0)
        throw OutputError("HDF5 cannot make the results in memory: there is too little of it");
      return id;
    }

    /// An HDF5 object that is closed by the function that belongs to it.
    class Handle
    {
    public:
      Handle(const hid_t id, herr_t (*close)(hid_t))
          : id_(require(id))
          , close_(close)
      {
      }
      ~Handle() { close_(id_); }
      Handle(const Handle &) = delete;
      operator hid_t() const { return id_; }

    private:
      hid_t id_;
      herr_t (*close_)(hid_t);
    };

    void write_text(const hid_t object, const std::string &name, const std::string &value)
    {
      const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
      require(H5Tset_size(type, H5T_VARIABLE));
      const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
      const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
      const char *const text = value.c_str();
      require(H5Awrite(attribute, type, &text));
    }
  } // namespace

  struct Hdf5File::Implementation
  {
    Handle file;

    void write(const std::string &folder, const std::string &name, const std::vector<std::size_t> &shape,
               hid_t type, const void *values, const std::string &unit,
               const std::vector<std::string> &scales) const;
  };

  namespace
  {
    hid_t create_in_memory()
    {
      constexpr std::size_t step = 1 << 20; // by which it grows [bytes]
      const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      require(H5Pset_fapl_core(access, step, false));
      return H5Fcreate("results", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    }
  } // namespace

  Hdf5File::Hdf5File()
      : implementation_(new Implementation{ { create_in_memory(), H5Fclose } })
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // what fails is said in one line of our own
  }

  void Hdf5File::write_to(const std::string &path)
  {
    require(H5Fflush(implementation_->file, H5F_SCOPE_GLOBAL));
    const ssize_t size = H5Fget_file_image(implementation_->file, nullptr, 0);
    require(size < 0 ? -1 : 0);
    std::string image(static_cast<std::size_t>(size), '\0');
    require(H5Fget_file_image(implementation_->file, image.data(), image.size()) == size ? 0 : -1);
    CheckedFile file(path);
    file.write(image);
    file.finish();
  }

  Hdf5File::~Hdf5File() = default;

  void Hdf5File::Implementation::write(const std::string &folder, const std::string &name,
                                       const std::vector<std::size_t> &shape, const hid_t type,
                                       const void *values, const std::string &unit,
                                       const std::vector<std::string> &scales) const
  {
    const std::vector<hsize_t> size(shape.begin(), shape.end());
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
        creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_create_intermediate_group(links, 1));
    require(H5Pset_obj_track_times(creation, false)); // equal results are equal files
    const auto path_of = [&](const std::string &of) { return folder.empty() ? of : folder + "/" + of; };
    const Handle dataset(H5Dcreate2(file, path_of(name).c_str(), type, space, links, creation, H5P_DEFAULT),
                         H5Dclose);
    require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
    write_text(dataset, "unit", unit);
    for (std::size_t dimension = 0; dimension < scales.size(); ++dimension)
      {
        const Handle scale(H5Dopen2(file, path_of(scales[dimension]).c_str(), H5P_DEFAULT), H5Dclose);
        if (H5DSis_scale(scale) == 0)
          require(H5DSset_scale(scale, scales[dimension].c_str()));
        require(H5DSattach_scale(dataset, scale, static_cast<unsigned>(dimension)));
      }
  }

  void Hdf5File::attribute(const std::string &name, const std::string &value)
  {
    write_text(implementation_->file, name, value);
  }

  void Hdf5File::dataset(const std::string &folder, const std::string &name,
                         const std::vector<std::size_t> &shape, const std::vector<double> &values,
                         const std::string &unit, const std::vector<std::string> &scales)
  {
    implementation_->write(folder, name, shape, H5T_NATIVE_DOUBLE, values.data(), unit, scales);
  }

  void Hdf5File::dataset(const std::string &folder, const std::string &name,
                         const std::vector<std::size_t> &shape, const std::vector<int> &values,
                         const std::string &unit, const std::vector<std::string> &scales)
  {
    implementation_->write(folder, name, shape, H5T_NATIVE_INT, values.data(), unit, scales);
  }
} // namespace flank
