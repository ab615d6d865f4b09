#include "apps/campaign/report.h"

#include <openssl/evp.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <regex>
#include <sstream>

#include "apps/report/markup.h"
#include "hal/text_file.h"

namespace jaywalk::campaign {
namespace {

constexpr const char* kHead = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>";
constexpr const char* kStyle =
    R"(</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root{color-scheme:light dark}
body{font:16px/1.5 sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;overflow-wrap:break-word}
.cards{display:flex;flex-wrap:wrap;gap:1rem}
.cards div{border:1px solid #8886;border-radius:.5rem;padding:.6rem 1rem;min-width:8rem}
.cards b{display:block;font-size:1.6rem}
table{border-collapse:collapse;margin:.5rem 0 1.5rem;font-size:.85rem}
th,td{padding:.2rem .7rem;border-bottom:1px solid #8886;text-align:right}
th{cursor:pointer;vertical-align:bottom}
th:first-child,td:first-child{text-align:left}
details table{font-size:.7rem}
details th,details td{padding:.15rem .25rem}
details td:first-child{overflow-wrap:anywhere}
code{background:#8883;padding:.1rem .3rem;overflow-wrap:anywhere}
figure{margin:1rem 0}
figure svg{max-width:100%;height:auto;background:#fff}
.wide{overflow-x:auto}
.failures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(22rem,100%),1fr));gap:1.5rem}
.failures img{width:100%;border:1px solid #8886;background:#fff}
@media(prefers-color-scheme:dark){figure svg,.failures img{filter:invert(.9) hue-rotate(180deg)}}
</style>
</head>
<body>
)";

/// A click on a head sorts by its column, another one the other way; what is no number comes last.
constexpr const char* kSorting = R"(<script>
document.querySelectorAll('th').forEach(head => head.onclick = () => {
  const [first, ...rows] = head.closest('table').rows, down = head.dataset.down = head.dataset.down ? '' : '1';
  const text = row => row.cells[head.cellIndex].textContent, number = row => parseFloat(text(row));
  rows.sort((a, b) => isNaN(number(a)) - isNaN(number(b)) || (down ? 1 : -1) * (number(a) - number(b) || text(a).localeCompare(text(b))));
  first.after(...rows);
});
</script>
)";

/// RFC 4648.
std::string base64(const std::string& bytes) {
  std::string out(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), reinterpret_cast<const unsigned char*>(bytes.data()),
                    static_cast<int>(bytes.size()));
  out.pop_back();  // a zero behind it
  return out;
}

std::string cells(const std::vector<std::string>& row, const std::string& kind) {
  std::string out = "<tr>";
  for (const std::string& cell : row) out += "<" + kind + ">" + as_markup(cell) + "</" + kind + ">";
  return out + "</tr>\n";
}

/// RFC 4180.
std::string csv_of(const ReportTable& table) {
  std::ostringstream out;
  const auto add = [&out](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) out << (k == 0 ? "" : ",") << std::quoted(row[k], '"', '"');
    out << "\r\n";
  };
  add(table.head);
  for (const auto& row : table.rows) add(row);
  return out.str();
}

/// Letters and digits of a title, words apart by '_'.
std::string file_name(const std::string& title) { return std::regex_replace(title, std::regex("[^0-9A-Za-z]+"), "_"); }

/// `folders`: the first cells link to folders of the campaign's.
std::string table_of(const ReportTable& table, bool folders = false) {
  std::string out = "<h3>" + as_markup(table.title) + "</h3>\n<div class=\"wide\"><table>\n" + cells(table.head, "th");
  for (const auto& row : table.rows) {
    std::string line = cells(row, "td");
    if (const std::string name = as_markup(row[0]); folders)
      line.replace(line.find(name), name.size(), "<a href=\"../" + name + "/\">" + name + "</a>");
    out += line;
  }
  return out + "</table></div>\n<p><a download=\"" + file_name(table.title) + ".csv\" href=\"data:text/csv;base64," +
         base64(csv_of(table)) + "\">CSV</a></p>\n";
}

std::string section_of(const ReportSection& section) {
  std::string out = "<h2>" + as_markup(section.title) + "</h2>\n";
  for (const ReportChart& chart : section.charts)
    out += "<figure>\n" + chart.svg + "<figcaption>" + as_markup(chart.title) + "</figcaption>\n</figure>\n";
  for (const ReportTable& table : section.tables) out += table_of(table);
  return out;
}

std::string failure_of(const ReportFailure& failure) {
  std::string out = "<article>\n<h3>" + as_markup(failure.run) + "</h3>\n<p>" + as_markup(failure.what) + "</p>\n";
  if (!failure.svg.empty())
    out += "<img loading=\"lazy\" alt=\"the run, moving\" src=\"data:image/svg+xml;base64," + base64(failure.svg) +
           "\">\n";
  out += "<p><code>" + as_markup(failure.repeat) + "</code></p>\n";
  if (!failure.why.empty()) out += "<p><code>" + as_markup(failure.why) + "</code></p>\n";
  return out + "</article>\n";
}

/// A '|' in a cell would end it.
std::string cells(const std::vector<std::string>& row) {
  std::string out = "|";
  for (const std::string& cell : row) out += " " + std::regex_replace(cell, std::regex("\\|"), "\\|") + " |";
  return out + "\n";
}

std::string table_in_markdown(const ReportTable& table) {
  std::string out = "**" + table.title + "**\n\n" + cells(table.head) + "|";
  for (std::size_t k = 0; k < table.head.size(); ++k) out += k == 0 ? "---|" : "---:|";
  out += "\n";
  for (const auto& row : table.rows) out += cells(row);
  return out + "\n";
}

std::string section_in_markdown(const ReportSection& section) {
  std::string out = "## " + section.title + "\n\n";
  for (const ReportChart& chart : section.charts) out += "![" + chart.title + "](charts/" + chart.name + ".svg)\n\n";
  for (const ReportTable& table : section.tables) out += table_in_markdown(table);
  return out;
}

std::string failure_of(const ReportFailure& failure, std::size_t number) {
  const std::string picture = "failures/" + std::to_string(number) + ".svg";
  const std::string name = failure.svg.empty() ? failure.run : "[" + failure.run + "](" + picture + ")";
  std::string out = std::to_string(number) + ". " + name + ": " + failure.what + "\n   `" + failure.repeat + "`\n";
  if (!failure.why.empty()) out += "   `" + failure.why + "`\n";
  return out;
}

ReportFailure failure_of(const ReportedRun& run) {
  const bool moment = std::isfinite(run.result.at_s);
  const std::string at_s = fixed(run.result.at_s, 2);
  return {run.run->folder, run.result.outcome + (moment ? " at " + at_s + " s" : "") + ": " + run.result.reason,
          run.run->command, moment ? "jaywalk why out/" + run.run->folder + " " + at_s + " --out out/why" : "",
          text_in(run.folder / "run.svg")};
}

ReportSection section_of(const ReportedTables& tables) {
  const ReportedExperiment& experiment = *tables.experiment;
  ReportSection section{experiment.title, tables_of(tables), {}};
  section.charts.push_back(
      {"turns_" + experiment.name,
       "Turning angles every 0.25 m, degrees; heights are shares from 0.01 % to 100 %, by tenfolds",
       turn_chart(tables.rows)});
  if (std::string chart = map_chart(tables); !chart.empty())
    section.charts.push_back(
        {"maps_" + experiment.name,
         "Seconds lost against the shortest way, by map: columns as the tables' rows, a dot a run, "
         "an open one did not arrive",
         std::move(chart)});
  return section;
}

/// Of all runs' robot.csv in the plan's order: two programs that give the same drive alike.
std::string digest_of(const std::vector<ReportedTables>& all) {
  std::string digests;
  for_each_run(all, [&](const ReportedRun& run) { digests += run.result.robot_csv + "\n"; });
  return digest_of_text(digests);
}

void require_one_campaign(const std::vector<std::filesystem::path>& folders) {
  for (const std::filesystem::path& folder : folders) {
    if (!is_campaign(folder))
      throw StartupError(folder.string() + ": holds no campaign", "give folders of one campaign, or a single run's");
    if (text_in(folder / "campaign.json") != text_in(folders.front() / "campaign.json"))
      throw StartupError(folder.string() + ": holds another campaign than " + folders.front().string(),
                         "give folders of the same campaign, scenarios and program");
  }
}

ReportedTables read_tables(const std::vector<std::filesystem::path>& folders, const ReportedExperiment& experiment) {
  ReportedTables tables{&experiment, {}};
  for (const PlannedRun& run : experiment.runs) {
    if (tables.rows.empty() || tables.rows.back().values != run.values)
      tables.rows.push_back({run.row, run.values, {}});
    const auto has_it = [&](const auto& folder) { return std::filesystem::exists(place_of(folder, run) / "run.json"); };
    const auto folder = std::find_if(folders.begin(), folders.end(), has_it);
    if (folder == folders.end()) continue;
    const std::filesystem::path place = place_of(*folder, run);
    tables.rows.back().runs.push_back({&run, read_result(place / "run.json"), place});
  }
  return tables;
}

std::vector<double> sorted(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

std::string html_of(const ReportPage& page) {
  std::string out = kHead + as_markup(page.title) + kStyle + "<h1>" + as_markup(page.title) + "</h1>\n<p>" +
                    as_markup(page.text) + "</p>\n<div class=\"cards\">\n";
  for (const auto& [figure, what] : page.cards)
    out += "<div><b>" + as_markup(figure) + "</b>" + as_markup(what) + "</div>\n";
  out += "</div>\n";
  for (const ReportSection& section : page.sections) out += section_of(section);
  out += "<details><summary>" + std::to_string(page.runs.rows.size()) + " runs, a row each</summary>\n" +
         table_of(page.runs, true) + "</details>\n<h2>Failures</h2>\n";
  out += page.failures.empty() ? "<p>None.</p>\n<div>\n" : "<div class=\"failures\">\n";
  for (const ReportFailure& failure : page.failures) out += failure_of(failure);
  return out + "</div>\n" + kSorting + "</body>\n</html>\n";
}

std::string markdown_of(const ReportPage& page) {
  std::string out = "# " + page.title + "\n\n" + page.text + "\n\n";
  for (const auto& [figure, what] : page.cards) out += "- **" + figure + "** " + what + "\n";
  out += "\n";
  for (const ReportSection& section : page.sections) out += section_in_markdown(section);
  out += "## Failures\n\n";
  if (page.failures.empty()) return out + "None.\n";
  std::size_t number = 0;
  for (const ReportFailure& failure : page.failures) out += failure_of(failure, ++number);
  return out;
}

bool is_campaign(const std::filesystem::path& folder) { return std::filesystem::exists(folder / "campaign.json"); }

ReportPage page_of(const std::vector<std::filesystem::path>& folders) {
  require_one_campaign(folders);
  const ReportedCampaign campaign = read_plan(folders.front() / "campaign.json");
  std::vector<ReportedTables> all;
  std::size_t planned = 0;
  for (const ReportedExperiment& experiment : campaign.experiments) {
    all.push_back(read_tables(folders, experiment));
    planned += experiment.runs.size();
  }
  ReportPage page;
  page.title = campaign.title;
  page.cards = cards_of(all);
  page.runs = runs_table(all);
  page.missing = planned - page.runs.rows.size();
  page.text = std::to_string(planned) + " runs by " + campaign.program +
              "; all tables robot.csv together: " + digest_of(all) + ".";
  if (page.missing > 0) page.text += " " + std::to_string(page.missing) + " runs are missing: they are in no table.";
  page.text +=
      " Success is the strict rule: the goal reached in time, nothing touched, no mover made to turn by the robot. "
      "Intervals are Wilson's, of 95 %.";
  if (const std::vector<SuccessLine> lines = success_lines(all); !lines.empty())
    page.sections.push_back({"Success against movers",
                             {success_table(lines)},
                             {{"success", "Success against movers, with intervals of 95 %", success_chart(lines)}}});
  for (const ReportedTables& tables : all) page.sections.push_back(section_of(tables));
  for_each_run(all, [&](const ReportedRun& run) {
    if (!run.result.success) page.failures.push_back(failure_of(run));
  });
  return page;
}

Interval wilson(std::size_t successes, std::size_t runs) {
  if (runs == 0) return {};
  constexpr double z = 1.96;
  const auto s = static_cast<double>(successes), n = static_cast<double>(runs);
  const double centre = (s + z * z / 2.0) / (n + z * z);
  const double half = z / (n + z * z) * std::sqrt(s * (n - s) / n + z * z / 4.0);
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

double median(std::vector<double> values) {
  values = sorted(std::move(values));
  if (values.empty()) return kUnknown;
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

double quantile(std::vector<double> values, double share) {
  values = sorted(std::move(values));
  if (values.empty()) return kUnknown;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

double half_interval(const std::vector<double>& values) {
  constexpr double z = 1.96;
  const double n = static_cast<double>(values.size()), middle = mean(values), free = n - 1.0;
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const double t = z + (z * z * z + z) / (4.0 * free) +
                   (5.0 * std::pow(z, 5) + 16.0 * std::pow(z, 3) + 3.0 * z) / (96.0 * free * free);
  return t * std::sqrt(squares / free / n);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value, ++count;
  return count > 0.0 ? sum / count : kUnknown;
}

std::string fixed(double value, int digits) {
  if (std::isnan(value)) return "-";
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

}  // namespace jaywalk::campaign
