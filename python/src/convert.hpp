#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/core/stop.hpp"

namespace slipfit::python {

namespace py = pybind11;

/// Contiguous doubles as they are; of anything else a copy.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Option and text, as a manifest would say it.
using Cells = std::vector<std::pair<std::string, std::string>>;

/// Raises slipfit.Error with the code and the message.
[[noreturn]] void raise(const Error& error);

template <class T>
T value_or_raise(Result<T> result) {
  if (!result) raise(result.error());
  return std::move(result).value();
}

/// The result of `work()`, during which other Python threads run. It must not touch Python.
template <class Work>
auto without_gil(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

/// The result of `work()` like that of without_gil; a signal that Python turns into an exception (Ctrl-C) ends it.
template <class Work>
auto interruptible(const Work& work) {
  constexpr auto kBetweenLooks = std::chrono::milliseconds(50);
  const auto stop = std::make_shared<std::atomic<bool>>(false);
  std::optional<py::error_already_set> raised;
  auto result = [&] {
    const py::gil_scoped_release release;
    auto done = std::async(std::launch::async, [&] {
      const StopScope scope(stop);
      return work();
    });
    while (!*stop && done.wait_for(kBetweenLooks) != std::future_status::ready) {
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() == 0) continue;
      raised.emplace();
      *stop = true;
    }
    try {
      return std::optional(done.get());
    } catch (const Stopped&) {
      return decltype(std::optional(done.get()))();
    }
  }();
  if (raised) throw py::error_already_set(std::move(*raised));
  return *std::move(result);
}

/// A copy for Python to keep.
py::array_t<double> array_of(const std::vector<double>& values);

// Each adds its classes and functions.
void add_recordings(py::module_& module);
void add_results(py::module_& module);
void add_documents(py::module_& module);
void add_batch(py::module_& module);

}  // namespace slipfit::python
