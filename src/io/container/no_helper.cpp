#include "io/container/formats.hpp"

// In place of helper.cpp where no program can be started.

namespace slipfit::reading {

Result<HelperOutput> run_helper(const Helper& helper, const std::string& name) {
  return Error{"not_built_in", name + ": " + helper.kind +
                                   ", which slipfit cannot read in a browser; export it as text, or use the program"};
}

Result<TextStream> open_hdf5(TextStream /*packed*/, const std::string& name, const ContainerChoice& /*choice*/) {
  return run_helper({{}, {}, "a MATLAB or HDF5 file", {}}, name).error();
}

Result<TextStream> open_mat(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  return open_hdf5(std::move(packed), name, choice);
}

}  // namespace slipfit::reading
