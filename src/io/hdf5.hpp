// HDF5 files: named arrays in groups, with attributes. The only way to HDF5; hdf5.h is included by hdf5.cpp
// alone.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/vec3.hpp"

namespace bagnold::io {

using Dims = std::vector<std::size_t>;

enum class Compress { no, yes };  // yes: shuffle + deflate, for big arrays that are written once

// An open file. Every error is an IoError that names the file and the dataset. The same calls write the same
// bytes: no time stamps, no host names.
//
//   auto file = H5File::create("run.h5");
//   file.write("snapshots/0000/x", grains.x);
//   file.attribute("snapshots/0000", "t", time);
//   file.flush();   // a process killed from here on leaves a readable file
class H5File {
 public:
  static H5File create(const std::filesystem::path& path);  // replaces what is there
  static H5File read_only(const std::filesystem::path& path);
  static H5File append(const std::filesystem::path& path);  // opens for writing, creates when absent
  H5File(H5File&&) noexcept;
  H5File& operator=(H5File&&) noexcept;
  H5File(const H5File&) = delete;
  H5File& operator=(const H5File&) = delete;
  ~H5File();  // closes; errors are only reported by close()

  const std::filesystem::path& path() const;
  void flush();  // hands everything written so far to the operating system
  void close();

  // Writes an array, row-major, of the shape `dims` (default: one dimension; n x 3 for Vec3). Groups on the
  // way are created; an array already there is replaced. T: double, float, int32, int64, uint8, Vec3.
  template <class T>
  void write(const std::string& dataset, std::span<const T> data, Dims dims = {}, Compress compress = Compress::no);
  template <class T>
  void write(const std::string& dataset, const std::vector<T>& data, Dims dims = {}, Compress compress = Compress::no) {
    write(dataset, std::span<const T>(data), std::move(dims), compress);
  }

  // The whole array. Numbers that would not fit in T (a fraction in an integer, 64 bits in 32) are an error.
  template <class T>
  std::vector<T> read(const std::string& dataset) const;
  Dims dims(const std::string& dataset) const;

  bool exists(const std::string& object) const;
  std::vector<std::string> children(const std::string& group) const;  // names, sorted; "/" is the root
  void remove(const std::string& object);                             // a dataset, or a group with all in it
  void create_group(const std::string& group);                        // nothing to do when it exists

  // Attributes of a group or dataset. Setting one on a path that does not exist creates a group there.
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  void attribute(const std::string& object, const std::string& name, const char* value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::integral auto value) {
    int_attribute(object, name, static_cast<std::int64_t>(value));
  }
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::string string_attribute(const std::string& object, const std::string& name) const;
  double double_attribute(const std::string& object, const std::string& name) const;
  std::int64_t int_attribute(const std::string& object, const std::string& name) const;

 private:
  struct Impl;
  void int_attribute(const std::string& object, const std::string& name, std::int64_t value);
  explicit H5File(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bagnold::io
