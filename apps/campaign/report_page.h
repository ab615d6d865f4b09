#pragma once
// A campaign's report before it has a form: HTML and Markdown say the same.
#include <string>
#include <vector>

namespace jaywalk::campaign {

struct ReportTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct ReportChart {
  std::string name;  ///< of its file, without ".svg"
  std::string title;
  std::string svg;
};

struct ReportFailure {
  std::string run;     ///< its folder below the campaign's: "movers/movers.count=16/map1_16/101"
  std::string what;    ///< "forced_mover at 34.2 s: mover 7 had to turn for the robot, ..."
  std::string repeat;  ///< the command, in the campaign file's folder
  std::string why;     ///< the command that explains the moment; empty where there is none
  std::string svg;     ///< the moving picture; empty where there is none
};

struct ReportSection {
  std::string title;
  std::string text;
  std::vector<ReportTable> tables;
  std::vector<ReportChart> charts;
};

/// A figure that is read first.
struct ReportCard {
  std::string figure;  ///< "94.0 %"
  std::string what;
};

struct ReportPage {
  std::string title;
  std::string text;
  std::vector<ReportCard> cards;
  std::vector<ReportSection> sections;
  std::vector<ReportFailure> failures;
  ReportTable runs;  ///< those that are finished; the first cell is the folder below the campaign's
};

/// One file that needs no other: charts, pictures and tables to download are in it. Its links to the runs' folders hold
/// where it lies in a folder of the campaign's.
[[nodiscard]] std::string html_of(const ReportPage& page);
/// Refers to charts beside it (charts/NAME.svg) and to pictures (failures/NUMBER.svg, from 1).
[[nodiscard]] std::string markdown_of(const ReportPage& page);

}  // namespace jaywalk::campaign
