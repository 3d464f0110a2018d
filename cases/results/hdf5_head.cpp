// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/results/hdf5_head.hpp"

#include "cases/results/hdf5_file.hpp"

namespace flank
{
  void write_head(Hdf5File &file, const HeadOfRun &head)
  {
    file.attribute("title", head.title);
    file.attribute("case_as_given", head.case_as_given);
    file.attribute("case_as_resolved", head.case_as_resolved);
    file.attribute("versions", head.versions);
    file.attribute("conventions", head.conventions);
  }

  void write_head_of_study(Hdf5File &file, const HeadOfStudy &head)
  {
    file.attribute("case", head.case_as_given);
    file.attribute("case_resolved", head.case_as_resolved);
    file.attribute("study", head.axes);
    file.attribute("versions", head.versions);
  }
} // namespace flank
