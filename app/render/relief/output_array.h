// SPDX-License-Identifier: Apache-2.0
// An array that is rewritten for every picture, a few elements at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace relievo {

// A vector whose writer reserves room for many elements at once and writes them in place: no element is initialised
// first and no capacity is checked per element. Clearing keeps the memory.
template <class T>
class OutputArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_default_constructible_v<T>);

 public:
  OutputArray() = default;
  OutputArray(OutputArray&& other) noexcept { *this = std::move(other); }
  OutputArray& operator=(OutputArray&& other) noexcept {
    data_ = std::move(other.data_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }

  void clear() noexcept { size_ = 0; }
  // The end of the array, with room for `count` more elements, valid until the next `room` or `add`. Elements written
  // there count after `endAt`.
  [[nodiscard]] T* room(std::size_t count) {
    if (size_ + count > capacity_) grow(size_ + count);
    return data_.get() + size_;
  }
  void endAt(const T* end) noexcept { size_ = static_cast<std::size_t>(end - data_.get()); }
  // `elements` must not point into this array.
  void add(std::span<const T> elements) { endAt(std::ranges::copy(elements, room(elements.size())).out); }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const T* data() const noexcept { return data_.get(); }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  [[nodiscard]] const T* begin() const noexcept { return data_.get(); }
  [[nodiscard]] const T* end() const noexcept { return data_.get() + size_; }

 private:
  void grow(std::size_t least) {
    const std::size_t capacity = std::max(least, 2 * capacity_);
    auto larger = std::make_unique_for_overwrite<T[]>(capacity);
    std::copy_n(data_.get(), size_, larger.get());
    data_ = std::move(larger);
    capacity_ = capacity;
  }

  std::unique_ptr<T[]> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace relievo
