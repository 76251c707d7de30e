#include "fit/problem/lines.hpp"

namespace slipfit::fit {

using Eigen::Index;

bool evaluate_lines(const CycleModel& model, const CycleValues& values, Eigen::MatrixXd& lines) {
  const auto columns = static_cast<Index>(model.columns().size());
  lines.resize(static_cast<Index>(model.residuals()), columns + 1);
  return model.evaluate(values, lines.col(columns).data(), lines.data());
}

void products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines, Eigen::Ref<RowMajor> products) {
  for (Index a = 0; a < lines.cols(); ++a) {  // quicker than a product of matrices of so few columns
    for (Index b = a; b < lines.cols(); ++b) products(a, b) = lines.col(a).dot(lines.col(b));
  }
}

RowMajor products_of(const Eigen::Ref<const Eigen::MatrixXd>& lines) {
  RowMajor products(lines.cols(), lines.cols());
  products_of(lines, products);
  return products;
}

RowMajor products_of(const SteadyResidual& steady, const Columns& columns) {
  Eigen::RowVectorXd line(static_cast<Index>(columns.coordinates().size()) + 2);
  Index next = 0;
  for (const Coordinate coordinate : columns.coordinates()) line(next++) = steady.by_value(coordinate);
  line.tail<2>() << steady.by_level, steady.value;
  return line.transpose() * line;
}

}  // namespace slipfit::fit
