#include <fmt/format.h>

#include "io/container/formats.hpp"

namespace slipfit::reading {

ThrownError damaged(const std::string& name, const std::string& what) {
  return ThrownError({"damaged_container", fmt::format("{}: {}; copy or export the file again", name, what)});
}

ThrownError too_large(const std::string& name) {
  return ThrownError(
      {"container_too_large",
       name + ": unpacks to far more than a recording holds; unpack it yourself and give the file in it"});
}

ThrownError not_built_in(const std::string& name, const std::string& kind, const std::string& package) {
  return ThrownError(
      {"not_built_in", fmt::format("{}: {}, which this build of slipfit cannot read; export it as CSV, or build "
                                   "slipfit with Debian's {}",
                                   name, kind, package)});
}

TextStream open_old_workbook(TextStream /*packed*/, const std::string& name, const ContainerChoice& /*choice*/) {
  throw ThrownError({"old_workbook", name + ": a workbook in the format of before 2007 (.xls), or another document of "
                                            "that kind; save it as .xlsx or CSV"});
}

}  // namespace slipfit::reading
