#include "io/checkpoint.hpp"

#include <fmt/format.h>

#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"

namespace bagnold::io {
namespace {

constexpr std::int64_t format_version = 1;

template <class T>
constexpr bool is_vector = false;
template <class T>
constexpr bool is_vector<std::vector<T>> = true;

// FNV-1a over 8 bytes at a time: finds damage, resists nobody.
std::int64_t checksum(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto mix = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
  for (; bytes >= 8; p += 8, bytes -= 8) {
    std::uint64_t word;
    std::memcpy(&word, p, 8);
    mix(word);
  }
  for (; bytes > 0; ++p, --bytes) mix(*p);
  return static_cast<std::int64_t>(hash);
}

template <class T>
std::int64_t checksum(std::span<const T> values) {
  return checksum(values.data(), values.size_bytes());
}

template <class T>
void write_array(H5File& file, const std::string& dataset, std::span<const T> values) {
  file.write(dataset, values);
  file.attribute(dataset, "checksum", checksum(values));
}

template <class T>
std::vector<T> read_array(const H5File& file, const std::string& dataset) {
  auto values = file.read<T>(dataset);
  if (checksum(std::span<const T>(values)) != file.int_attribute(dataset, "checksum"))
    throw IoError(fmt::format("{}: error: '{}': the checksum does not match", file.path().string(), dataset));
  return values;
}

void collect_datasets(const H5File& file, const std::string& group, std::vector<std::string>& names) {
  for (const auto& child : file.children(group)) {
    const auto path = group + "/" + child;
    if (file.has_attribute(path, "checksum")) {
      names.push_back(path);
    } else {
      collect_datasets(file, path, names);
    }
  }
}

// Damage is an IoError, another model's state an InputError. Returns what has to be done to take the state
// over.
std::vector<std::function<void()>> read_state(const H5File& file, const std::vector<NamedArray>& state) {
  if (!file.has_attribute("/", "complete"))
    throw IoError(fmt::format("{}: error: the checkpoint is incomplete", file.path().string()));
  if (const auto found = file.int_attribute("/", "format"); found != format_version)
    throw InputError(fmt::format("{}: error: checkpoint format {}, this program reads {}", file.path().string(), found,
                                 format_version));
  const auto mismatch = [&](const std::string& what) {
    return InputError(
        fmt::format("{}: error: {}: the checkpoint belongs to another model or version", file.path().string(), what));
  };

  std::vector<std::function<void()>> take_over;
  for (const NamedArray& entry : state) {
    const auto dataset = "state/" + entry.name;
    if (!file.exists(dataset)) throw mismatch(fmt::format("no array '{}'", entry.name));
    std::visit(
        [&](auto* target) {
          using T = std::remove_pointer_t<decltype(target)>;
          if constexpr (is_vector<T>) {
            take_over.push_back([target, values = read_array<typename T::value_type>(file, dataset)]() mutable {
              *target = std::move(values);
            });
          } else {
            const auto values = read_array<T>(file, dataset);
            if (values.size() != 1) throw mismatch(fmt::format("'{}' is not a single number", entry.name));
            take_over.push_back([target, value = values[0]] { *target = value; });
          }
        },
        entry.array);
  }
  std::vector<std::string> stored;
  collect_datasets(file, "state", stored);
  for (const auto& dataset : stored) {
    bool known = false;
    for (const auto& [name, array] : state) known = known || dataset == "state/" + name;
    if (!known) throw mismatch(fmt::format("unexpected array '{}'", dataset.substr(6)));
  }
  return take_over;
}

// use(file) for the newest checkpoint that does not throw an IoError.
template <class Use>
RestoredFrom with_newest(const std::filesystem::path& directory, Use&& use) {
  RestoredFrom from;
  for (const char* name : {"checkpoint.h5", "checkpoint.prev.h5"}) {
    from.file = directory / name;
    try {
      const auto file = H5File::read_only(from.file);
      from.provenance = read_provenance(file);
      use(file);
      return from;
    } catch (const IoError& error) {
      from.damage += (from.damage.empty() ? "" : "\n") + std::string(error.what());
      from.previous = true;
    }
  }
  throw IoError(fmt::format("{}: error: no checkpoint can be read\n{}", directory.string(), from.damage));
}

}  // namespace

void write_checkpoint(const std::filesystem::path& directory, const std::vector<NamedArray>& state,
                      const Provenance& provenance) {
  const auto newest = directory / "checkpoint.h5";
  const auto part = part_of(newest);
  {
    auto file = H5File::create(part);
    write_provenance(file, provenance);
    file.attribute("/", "format", format_version);
    file.create_group("state");
    for (const NamedArray& entry : state) {
      const auto dataset = "state/" + entry.name;
      std::visit(
          [&](const auto* source) {
            using T = std::remove_cvref_t<decltype(*source)>;
            if constexpr (is_vector<T>) {
              write_array(file, dataset, std::span<const typename T::value_type>(*source));
            } else {
              write_array(file, dataset, std::span<const T>(source, 1));
            }
          },
          entry.array);
    }
    file.attribute("/", "complete", 1);
    file.close();
  }
  sync_to_disk(part);
  if (std::filesystem::exists(newest)) rename_durably(newest, directory / "checkpoint.prev.h5");
  rename_durably(part, newest);
}

RestoredFrom read_checkpoint(const std::filesystem::path& directory, const std::vector<NamedArray>& state) {
  std::vector<std::function<void()>> take_over;
  auto from = with_newest(directory, [&](const H5File& file) { take_over = read_state(file, state); });
  for (const auto& take : take_over) take();
  return from;
}

Provenance checkpoint_provenance(const std::filesystem::path& directory) {
  return with_newest(directory, [](const H5File&) {}).provenance;
}

}  // namespace bagnold::io
