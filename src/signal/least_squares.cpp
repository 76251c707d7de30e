#include "signal/least_squares.hpp"

#include <Eigen/QR>

namespace slipfit::signal {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values) {
  return columns.colPivHouseholderQr().solve(values);
}

}  // namespace slipfit::signal
