#include "apps/campaign/report_page.h"

namespace jaywalk::campaign {
namespace {

/// A '|' would end a cell.
std::string cell_of(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string cells(const std::vector<std::string>& row) {
  std::string out = "|";
  for (const std::string& cell : row) out += " " + cell_of(cell) + " |";
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
  if (!section.text.empty()) out += section.text + "\n\n";
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

}  // namespace

std::string markdown_of(const ReportPage& page) {
  std::string out = "# " + page.title + "\n\n" + page.text + "\n\n";
  for (const ReportCard& card : page.cards) out += "- **" + card.figure + "** " + card.what + "\n";
  out += "\n";
  for (const ReportSection& section : page.sections) out += section_in_markdown(section);
  out += "## Failures\n\n";
  if (page.failures.empty()) return out + "None.\n";
  std::size_t number = 0;
  for (const ReportFailure& failure : page.failures) out += failure_of(failure, ++number);
  return out;
}

}  // namespace jaywalk::campaign
