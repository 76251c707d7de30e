#include "convert.hpp"
#include "slipfit/core/remedy.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/report/quantities.hpp"

namespace slipfit::python {

void raise(const Error& error) {
  const py::object type = py::module_::import("slipfit._errors").attr("Error");
  const py::object exception = type(error.code, error.message);
  PyErr_SetObject(type.ptr(), exception.ptr());
  throw py::error_already_set();
}

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

namespace {

Dimension dimension_called(const std::string& name) {
  if (name == "time") return Dimension::Time;
  if (name == "length") return Dimension::Length;
  if (name == "speed") return Dimension::Speed;
  if (name == "force") return Dimension::Force;
  if (name == "frequency") return Dimension::Frequency;
  if (name == "mass") return Dimension::Mass;
  if (name == "angular_speed") return Dimension::AngularSpeed;
  return Dimension::Dimensionless;
}

/// key: (words, unit)
py::dict quantity_words() {
  py::dict words;
  for (const Quantity& quantity : recording_quantities()) {
    words[py::str(std::string(quantity.key))] = py::make_tuple(full_words(quantity), std::string(quantity.unit));
  }
  return words;
}

}  // namespace
}  // namespace slipfit::python

PYBIND11_MODULE(_slipfit, module) {
  using namespace slipfit::python;
  module.attr("__version__") = SLIPFIT_VERSION;
  module.def(
      "quantity",
      [](const std::string& text, const std::string& dimension) {
        return value_or_raise(slipfit::parse_quantity(text, dimension_called(dimension)));
      },
      "A number (SI) or a number with a unit, in SI.");
  module.def(
      "remedy",
      [](const std::string& code, const std::string& message) {
        return slipfit::remedy_of({code, message});
      },
      "What to do about an error.");
  module.def("quantity_words", quantity_words, "The words for each quantity of a document, and its unit.");
  add_recordings(module);
  add_results(module);
  add_documents(module);
  add_batch(module);
}
