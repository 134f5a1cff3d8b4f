#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "binding.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::python {

// --- from Python ------------------------------------------------------------
// All of these throw py::type_error or py::value_error with `what` in the message.

/// Numbers of any shape, row by row.
struct Numbers {
  std::vector<double> values;
  std::vector<std::size_t> shape;
};
/// Anything with the buffer protocol (numpy arrays of any strides and number type), or nested sequences of numbers. All
/// are finite.
[[nodiscard]] Numbers numbers_of(const py::handle& object, const std::string& what);
/// Whole numbers below 2^31 in size, d of them.
[[nodiscard]] IntegerVector integers_of(const py::handle& object, std::size_t dimension, const std::string& what);
/// At length 1. @throws also for the zero vector.
[[nodiscard]] Direction direction_of(const py::handle& object, std::size_t dimension, const std::string& what);
/// A normal, or a list of normals; dimension 0: as many entries as there are.
[[nodiscard]] std::vector<HalfSpace> half_spaces_of(const py::handle& object, std::size_t dimension);

// --- to Python --------------------------------------------------------------

[[nodiscard]] py::tuple to_tuple(const IntegerVector& v);
[[nodiscard]] py::tuple to_tuple(const Direction& v);
/// Normals, as tuples of whole numbers.
[[nodiscard]] py::list to_list(std::span<const HalfSpace> half_spaces);
/// Feature counts in units of 1: whole numbers, or real ones where they are expectations.
[[nodiscard]] py::tuple counts_to_tuple(const Domain& domain, const IntegerVector& counts);
/// The inverse.
[[nodiscard]] IntegerVector counts_of(const Domain& domain, const py::handle& object);

/// Memory of ours that arrays look at: read-only, and alive as long as one of them.
struct Array {
  std::shared_ptr<const void> owner;
  const void* data = nullptr;
  char format = 'd';  ///< As in the module struct: 'd', 'q' or '?'.
  std::vector<py::ssize_t> shape;
  std::vector<py::ssize_t> strides;  ///< In bytes.
};
[[nodiscard]] std::size_t item_size(char format) noexcept;
/// A numpy array over it; without numpy a memoryview.
[[nodiscard]] py::object as_array(Array array);
/// One row after the other.
[[nodiscard]] py::object as_array(std::vector<double> values, std::vector<py::ssize_t> shape);

}  // namespace kith::python
