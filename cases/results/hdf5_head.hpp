// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace flank
{
  class Hdf5File;

  /// What an HDF5 file of a run says of itself: attributes of its root, of these names.
  struct HeadOfRun
  {
    std::string title, case_as_given, case_as_resolved, versions, conventions;
  };
  void write_head(Hdf5File &file, const HeadOfRun &head);

  /// What an HDF5 file of a study says of itself: attributes `case` (as given), `case_resolved`, `study` (its
  /// axes), `versions`.
  struct HeadOfStudy
  {
    std::string case_as_given, case_as_resolved, axes, versions;
  };
  void write_head_of_study(Hdf5File &file, const HeadOfStudy &head);
} // namespace flank
