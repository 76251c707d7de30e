#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fit/problem/common_columns.hpp"
#include "fit/problem/elimination.hpp"

namespace slipfit::fit {

/// One cycle's (or steady recording's, without own parameters) part of the normal equations at a solution.
struct Normal {
  std::vector<Eigen::Index> columns;  ///< of its common parameters among the problem's
  RowMajor products;                  ///< as Elimination takes it
  Eigen::VectorXd residuals;          ///< of a cycle; the samples around the slip come first

  [[nodiscard]] Eigen::Index common() const { return static_cast<Eigen::Index>(columns.size()); }
  [[nodiscard]] Eigen::Index own() const { return products.cols() - common() - 1; }
};

std::vector<Normal> normals_of(const Problem& problem);

/// Those of the other recordings, numbered as their own problem has it. `all`: without one of its recordings it is
/// `others`.
std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others);

}  // namespace slipfit::fit
