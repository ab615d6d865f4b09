// rosbag2's first storage: the tables topics and messages of an SQLite 3 file.
#include <sqlite3.h>

#include <memory>
#include <string>

#include "apps/formats/bag_file.h"
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

}  // namespace

void read_sqlite_bag(const std::filesystem::path& file, const BagSink& sink) {
  const Database database(file);
  Database::Rows check(database, "PRAGMA quick_check(1)");
  if (!check.next() || check.bytes(0) != "ok") database.refuse("damaged or cut: " + std::string(check.bytes(0)));
  Database::Rows messages(database,
                          "SELECT m.id, t.id IS NULL, t.name, t.type, t.serialization_format, m.timestamp, m.data "
                          "FROM messages m LEFT JOIN topics t ON t.id = m.topic_id ORDER BY m.timestamp, m.id");
  while (messages.next()) {
    if (messages.number(1) != 0) {
      database.refuse("message " + std::to_string(messages.number(0)) +
                      " is of a topic that the bag does not describe");
    }
    if (messages.bytes(4) != "cdr") continue;
    const Time logged{std::chrono::nanoseconds(messages.number(5))};
    sink({messages.bytes(2), ros1_name(messages.bytes(3)), Wire::kCdr, logged, messages.bytes(6)});
  }
}

}  // namespace jaywalk::exchange
