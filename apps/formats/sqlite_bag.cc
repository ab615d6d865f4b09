// rosbag2's first storage: the tables topics and messages of an SQLite 3 file.
#include <sqlite3.h>

#include <map>
#include <memory>
#include <string>

#include "apps/formats/bag_file.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

constexpr const char* kSqliteRemedy = "take an undamaged copy of it, or what 'sqlite3 FILE .recover' makes of this one";

struct Closes {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

class Database {
 public:
  explicit Database(const std::filesystem::path& file) : file_(file) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) refuse("no SQLite file that can be read");
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);  // its tables are a stranger's
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  }

  class Rows {
   public:
    Rows(const Database& database, const char* query) : database_(database) {
      sqlite3_stmt* made = nullptr;
      if (sqlite3_prepare_v2(database.database_.get(), query, -1, &made, nullptr) != SQLITE_OK) database.refuse();
      statement_.reset(made);
    }
    bool next() {
      const int code = sqlite3_step(statement_.get());
      if (code != SQLITE_ROW && code != SQLITE_DONE) database_.refuse();
      return code == SQLITE_ROW;
    }
    [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(statement_.get(), column); }
    [[nodiscard]] std::string_view bytes(int column) const {
      const void* at = sqlite3_column_blob(statement_.get(), column);
      const int size = sqlite3_column_bytes(statement_.get(), column);
      return at == nullptr ? std::string_view()
                           : std::string_view(static_cast<const char*>(at), static_cast<std::size_t>(size));
    }

   private:
    const Database& database_;
    std::unique_ptr<sqlite3_stmt, Closes> statement_;
  };

  [[noreturn]] void refuse(const std::string& cause) const {
    throw StartupError(file_.string() + ": " + cause, kSqliteRemedy);
  }
  [[noreturn]] void refuse() const { refuse(std::string("SQLite says: ") + sqlite3_errmsg(database_.get())); }

 private:
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Closes> database_;
};

struct Topic {
  std::string name, type;
  bool cdr = false;
};

std::map<std::int64_t, Topic> topics_of(const Database& database) {
  std::map<std::int64_t, Topic> topics;
  Database::Rows rows(database, "SELECT id, name, type, serialization_format FROM topics");
  while (rows.next()) {
    std::string type(rows.bytes(2));
    if (const std::size_t msg = type.find("/msg/"); msg != std::string::npos) type.erase(msg, 4);
    topics[rows.number(0)] = {std::string(rows.bytes(1)), type, rows.bytes(3) == "cdr"};
  }
  return topics;
}

}  // namespace

void read_sqlite_bag(const std::filesystem::path& file, const BagSink& sink) {
  require_readable(file, file.string() + ": ", "give a recording");
  const Database database(file);
  Database::Rows check(database, "PRAGMA quick_check(1)");
  if (!check.next() || check.bytes(0) != "ok") database.refuse("damaged or cut: " + std::string(check.bytes(0)));
  const std::map<std::int64_t, Topic> topics = topics_of(database);
  Database::Rows messages(database, "SELECT id, topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  while (messages.next()) {
    const auto topic = topics.find(messages.number(1));
    if (topic == topics.end()) {
      database.refuse("message " + std::to_string(messages.number(0)) +
                      " is of a topic that the bag does not describe");
    }
    if (!topic->second.cdr) continue;
    const Time logged{std::chrono::nanoseconds(messages.number(2))};
    sink({topic->second.name, topic->second.type, Wire::kCdr, logged, messages.bytes(3)});
  }
}

}  // namespace jaywalk::exchange
