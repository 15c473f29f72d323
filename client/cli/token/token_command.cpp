// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <optional>

#include "base/files.h"
#include "base/utc_time.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/token/key_command.h"
#include "protocol/secure/token/key_ring.h"
#include "protocol/secure/token/token_text.h"

namespace furrow::cli {
namespace {

namespace secure = protocol::secure;

struct TokenOptions {
  std::string key_file;
  std::vector<std::string> roles;
  std::string valid_for = "8h";
  std::string client_id;
  std::string out;
  std::string token;  // of `show`
  secure::Grant grant;
};

// A decimal or (0x) hexadecimal number of 64 bits.
std::optional<std::uint64_t> ParseClientId(std::string_view text) {
  const bool is_hexadecimal = text.starts_with("0x");
  if (is_hexadecimal) text.remove_prefix(2);
  std::uint64_t value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, is_hexadecimal ? 16 : 10);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

CLI::Validator ClientIdValidator() {
  return {[](std::string& text) {
            return ParseClientId(text) ? std::string()
                                       : "'" + text + "' is not a number of 64 bits";
          },
          ""};
}

Result<secure::ClientToken> MakeTokenOf(const TokenOptions& options) {
  const auto ring = secure::LoadKeyRing(options.key_file);
  FURROW_RETURN_IF_ERROR(ring);
  const std::uint64_t now = UnixNow();
  const secure::TokenKey* const key = ring->Newest(now);
  if (key == nullptr) {
    return Status(StatusCode::kNotFound, "all keys of the file have expired", options.key_file,
                  "add one with 'furrow token key new'");
  }
  const std::uint64_t expires = now + *ParseDuration(options.valid_for);
  if (expires > key->expires) {
    return Status(StatusCode::kInvalidArgument,
                  "the key " + secure::KeyIdText(key->id) + " expires before the token would, at " +
                      FormatUtc(key->expires),
                  options.key_file,
                  "use a shorter --for, or add a key with 'furrow token key new'");
  }
  secure::Grant grant = options.grant;
  secure::RandomSource& random = secure::SystemRandom();
  grant.client_id = options.client_id.empty() ? random.Number<std::uint64_t>()
                                              : *ParseClientId(options.client_id);
  for (const std::string& word : options.roles) {
    const auto role = secure::ParseRoles(word);
    FURROW_RETURN_IF_ERROR(role);
    grant.roles = grant.roles | *role;
  }
  return secure::MakeToken(key->id, key->key, expires, grant, random);
}

int NewToken(const TokenOptions& options) {
  const auto token = MakeTokenOf(options);
  if (!token.ok()) return Fail(token.status());
  const std::string text = secure::ToText(*token) + "\n";
  if (options.out.empty()) {
    std::fputs(text.c_str(), stdout);
    return kDone;
  }
  const Status status = WriteSecretFile(options.out, text);
  return status.ok() ? kDone : Fail(status);
}

void PrintGrant(const secure::Grant& grant) {
  std::printf("client    0x%016" PRIx64 "\n", grant.client_id);
  std::printf("roles     %s\n", secure::ToText(grant.roles).c_str());
  std::printf("subjects  %s\n", grant.subjects.c_str());
  std::printf("server    %s\n", grant.audience.empty() ? "any" : grant.audience.c_str());
  if (grant.packets_per_second == 0) {
    std::puts("rate      the limit of the server");
  } else {
    std::printf("rate      %" PRIu32 " packets per second\n", grant.packets_per_second);
  }
}

int ShowToken(const TokenOptions& options) {
  const bool is_text = options.token.starts_with(secure::kTokenPrefix);
  const auto token = is_text ? secure::ParseToken(options.token) : secure::LoadToken(options.token);
  if (!token.ok()) return Fail(token.status());
  secure::TokenHead head;
  (void)secure::ReadTokenHead(token->bytes, head);  // checked while it was parsed
  std::printf("key       %s\n", secure::KeyIdText(head.key_id).c_str());
  std::printf("expires   %s (%s)\n", FormatUtc(head.expires).c_str(),
              RemainingText(head.expires, UnixNow()).c_str());
  if (options.key_file.empty()) return kDone;
  const auto ring = secure::LoadKeyRing(options.key_file);
  if (!ring.ok()) return Fail(ring.status());
  const secure::TokenKey* const key = ring->Find(head.key_id);
  if (key == nullptr) {
    return Fail(
        {StatusCode::kNotFound,
         "the file does not have the key " + secure::KeyIdText(head.key_id) + " of the token",
         options.key_file});
  }
  secure::OpenedToken opened;
  if (const auto opening = secure::OpenToken(token->bytes, key->key, opened);
      opening != secure::TokenStatus::kOk) {
    return Fail({StatusCode::kParse,
                 std::string("the token cannot be opened: ") + secure::TokenStatusText(opening)});
  }
  PrintGrant(opened.grant);
  return kDone;
}

void AddNewToken(CLI::App& group, Action& action) {
  auto options = std::make_shared<TokenOptions>();
  CLI::App* command = group.add_subcommand("new", "Make a token");
  command
      ->add_option("--role", options->roles,
                   "What the holder may do (repeatable, or separated by commas)")
      ->required()
      ->delimiter(',')
      ->check(CLI::IsMember({"publish", "watch", "direct", "operate"}).description(""))
      ->type_name("publish|watch|direct|operate");
  command
      ->add_option("--subjects", options->grant.subjects,
                   "Subjects to publish or watch, as comma-separated globs")
      ->type_name("GLOBS")
      ->capture_default_str();
  command->add_option("--for", options->valid_for, "How long the token is valid")
      ->check(DurationValidator())
      ->type_name("DURATION")
      ->capture_default_str();
  command->add_option("--key", options->key_file, kKeyFileHelp)->required()->type_name("FILE");
  command
      ->add_option("--audience", options->grant.audience,
                   "Name of the only daemon that accepts the token (default: any daemon)")
      ->type_name("NAME");
  command
      ->add_option("--rate", options->grant.packets_per_second,
                   "Maximum packets per second (default: the limit of the daemon)")
      ->type_name("NUMBER");
  command
      ->add_option(
          "--client", options->client_id,
          "Id of the client; a token with the same id can renew a session (default: random)")
      ->check(ClientIdValidator())
      ->type_name("NUMBER");
  command
      ->add_option("--out", options->out,
                   "File to write, readable by you alone (default: standard output)")
      ->type_name("FILE");
  command->callback([options, &action] { action = [options] { return NewToken(*options); }; });
}

void AddShowToken(CLI::App& group, Action& action) {
  auto options = std::make_shared<TokenOptions>();
  CLI::App* command = group.add_subcommand("show", "Show the content of a token, without secrets");
  command->add_option("TOKEN", options->token, "Token as text (frw1_...), or a file with one")
      ->required();
  command
      ->add_option("--key", options->key_file,
                   "File with the keys that seal tokens, to show the sealed part as well")
      ->type_name("FILE");
  command->callback([options, &action] { action = [options] { return ShowToken(*options); }; });
}

}  // namespace

void AddToken(CLI::App& app, Action& action) {
  CLI::App* group = app.add_subcommand("token", "Make and show tokens that let clients in");
  group->require_subcommand(1);
  AddNewToken(*group, action);
  AddShowToken(*group, action);
  AddTokenKey(*group, action);
}

}  // namespace furrow::cli
