#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.hpp"
#include "io/escape.hpp"
#include "io/files.hpp"
#include "io/vtk.hpp"
#include "report/figures.hpp"
#include "report/grain_picture.hpp"
#include "report/layer_pictures.hpp"
#include "report/particle_picture.hpp"
#include "report/run_data.hpp"

namespace bagnold::report {
namespace {

using io::escaped;
using Json = nlohmann::ordered_json;

constexpr const char* style = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 68rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem; margin-bottom: 0 } h2 { font-size: 1.15rem; margin-top: 2rem }
.status { color: #555; margin-top: .2rem }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(28rem, 1fr)); gap: 1.5rem }
figure { margin: 0 } figure img { width: 100%; border: 1px solid #ddd } figcaption { font-size: .9rem; color: #444 }
table { border-collapse: collapse } th { text-align: left; font-weight: 600 } th, td { padding: .15rem 1.2rem .15rem 0; border-bottom: 1px solid #eee }
td { font-variant-numeric: tabular-nums } pre { background: #f6f6f6; padding: 1rem; overflow-x: auto; font-size: .85rem }
)";

std::string text_of(const Json& value) {
  if (value.is_null()) return "–";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return escaped(value.dump());
}

// Rows (dotted key, value) of a summary; x and x_err become one row.
void flatten(const Json& object, const std::string& prefix, std::vector<std::pair<std::string, std::string>>& rows) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) {
      flatten(value, prefix + key + ".", rows);
      continue;
    }
    const bool is_error = key.ends_with("_err") && object.contains(key.substr(0, key.size() - 4));
    if (is_error) continue;
    auto text = text_of(value);
    if (const auto error = object.find(key + "_err"); error != object.end() && error->is_number())
      text += fmt::format(" ± {:.2g}", error->get<double>());
    rows.emplace_back(prefix + key, text);
  }
}

std::string table_of(const std::vector<RunData>& runs) {
  std::vector<std::string> keys;
  std::vector<std::map<std::string, std::string>> cells;
  for (const auto& run : runs) {
    std::vector<std::pair<std::string, std::string>> rows;
    flatten(run.summary, "", rows);
    for (const auto& [key, value] : rows)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    cells.emplace_back(rows.begin(), rows.end());
  }
  std::string html = "<table>\n<tr><th></th>";
  for (const auto& run : runs) html += "<th>" + escaped(run.name) + "</th>";
  html += "</tr>\n";
  for (const auto& key : keys) {
    html += "<tr><th>" + escaped(key) + "</th>";
    for (const auto& cell : cells) html += "<td>" + (cell.contains(key) ? cell.at(key) : "") + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string field(const RunData& run, const std::string& key) {
  return run.summary.contains(key) ? text_of(run.summary[key]) : "unknown";
}

std::string headline(const std::vector<RunData>& runs) {
  std::string html;
  for (const auto& run : runs)
    html += fmt::format("<p class=\"status\"><b>{}</b>: {} ({}), {} at t = {}, bagnold {}</p>\n", escaped(run.name),
                        field(run, "scenario"), field(run, "model"), field(run, "status"), field(run, "time"),
                        field(run, "version"));
  return html;
}

// Draws name.<shown> and name.<format> in `folder` by `draw(file)`; the <figure> that shows it.
template <class Draw>
std::string drawn(const std::filesystem::path& folder, const std::vector<std::string>& formats, const std::string& name,
                  const std::string& caption, const Draw& draw, const std::string& shown = "svg") {
  for (const auto& format : formats)
    if (format != shown) draw(folder / (name + "." + format));
  draw(folder / (name + "." + shown));
  const auto image = io::read_file(folder / (name + "." + shown));
  const auto bytes = io::base64({reinterpret_cast<const std::uint8_t*>(image.data()), image.size()});
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/{1};base64,{2}\"><figcaption>{3}</figcaption></figure>\n",
      escaped(name), shown == "svg" ? "svg+xml" : shown, bytes, escaped(caption));
}

// The pictures of the layers in the runs; several in one dimension are also compared, and the numbers of that written.
std::vector<Picture> pictures_of_layers(const std::filesystem::path& folder,
                                        const std::vector<std::filesystem::path>& directories,
                                        const std::vector<RunData>& runs) {
  std::vector<std::optional<LayerFile>> files;
  for (std::size_t k = 0; k < runs.size(); ++k)
    files.push_back(
        LayerFile::open(directories[k], runs[k].summary.value("model", ""), runs[k].summary.value("scenario", "")));
  std::vector<LayerRun> layers, lines;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (files[k]) layers.push_back({runs[k].name, &*files[k], runs[k].series ? &*runs[k].series : nullptr});
  for (const LayerRun& run : layers)
    if (!run.layers->grid().two_d()) lines.push_back(run);
  auto pictures = layer_pictures(layers);
  if (lines.size() > 1) {
    const Comparison c = compare(lines);
    write_comparison(folder / "compared.csv", c);
    pictures.insert(pictures.begin(), compared_picture(c));
  }
  return pictures;
}

}  // namespace

void write_report(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& output,
                  const std::vector<std::string>& formats) {
  std::vector<RunData> runs;
  for (const auto& directory : directories) runs.push_back(read_run(directory));

  const auto folder = output.parent_path() / "figures";
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw IoError(fmt::format("{}: error: cannot be created: {}", folder.string(), failed.message()));
  std::string pictures;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (has_particles(directories[k]))  // ten thousand circles make a heavy .svg
      pictures += drawn(
          folder, formats, runs.size() == 1 ? "particles" : "particles_" + runs[k].name,
          "Particles of " + runs[k].name + ", coloured by speed.",
          [&](const auto& file) { draw_particles(directories[k], file); }, "png");
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (has_grains(directories[k]))
      pictures += drawn(folder, formats, runs.size() == 1 ? "grains" : "grains_" + runs[k].name,
                        "The last snapshot of " + runs[k].name + " from the side, its front layer.",
                        [&](const auto& file) { draw_grains(directories[k], file); });
  for (const Picture& p : pictures_of_layers(folder, directories, runs))
    pictures +=
        drawn(folder, formats, p.name, p.caption, [&](const auto& file) { io::plot(file, p.script, p.data, p.size); });
  for (const auto& figure : figures(runs))
    pictures += drawn(folder, formats, figure.name, figure.caption, [&](const auto& file) { draw(figure, file); });

  std::string title;
  for (const auto& run : runs) title += (title.empty() ? "" : ", ") + run.name;
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta "
      "charset=\"utf-8\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n"
      "<body>\n<h1>{0}</h1>\n{2}",
      escaped(title), style, headline(runs));
  if (!pictures.empty()) html += "<h2>Figures</h2>\n<div class=\"figures\">\n" + pictures + "</div>\n";
  html += "<h2>Numbers</h2>\n" + table_of(runs);
  for (const auto& run : runs)
    html += fmt::format("<h2>Input of {}</h2>\n<details><summary>case.toml</summary><pre>{}</pre></details>\n",
                        escaped(run.name), escaped(run.input));
  io::write_file(output, html + "</body>\n</html>\n");
}

}  // namespace bagnold::report
