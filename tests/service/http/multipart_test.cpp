// Forms with files, as curl and browsers write them and as nobody should.

#include "service/http/multipart.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "service/http/problem.hpp"

namespace sluice {
namespace {

Request form(const std::string& body,
             const std::string& type = "multipart/form-data; boundary=XX") {
  Request request;
  request.method = "POST";
  request.headers["content-type"] = type;
  request.body = body;
  return request;
}

std::string part(const std::string& head, const std::string& bytes) {
  return "--XX\r\nContent-Disposition: form-data; " + head + "\r\n\r\n" + bytes + "\r\n";
}

std::string refusal(const Request& request) {
  try {
    (void)read_form(request);
  } catch (const ApiError& error) {
    EXPECT_EQ(error.type(), ProblemType::bad_request);
    return error.what();
  }
  return "";
}

TEST(Multipart, PartsComeInOrderWithTheirNamesAndBytes) {
  const std::string binary("\0\r\n--X\r\n\xff--", 12);
  const Request request =
      form(part("name=\"scene\"", "{}") +
           part("name=\"mesh\"; filename=\"a b;c.stl\"\r\nContent-Type: model/stl", binary) +
           part("filename=plain.obj; name=other", "") + "--XX--\r\n");
  const std::vector<FormPart> parts = read_form(request);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "scene");
  EXPECT_EQ(parts[0].filename, "");
  EXPECT_EQ(parts[0].bytes, "{}");
  EXPECT_EQ(parts[1].filename, "a b;c.stl");
  EXPECT_EQ(parts[1].bytes, binary);
  EXPECT_EQ(parts[2].name, "other");
  EXPECT_EQ(parts[2].filename, "plain.obj");
  EXPECT_EQ(parts[2].bytes, "");
}

TEST(Multipart, WhatStandsBeforeAndAfterTheFormIsNoPart) {
  const Request request = form("before\r\n" + part("name=a", "1") + "--XX--\r\nafter");
  ASSERT_EQ(read_form(request).size(), 1u);
  EXPECT_TRUE(read_form(form("--XX--\r\n")).empty());
}

TEST(Multipart, OnlyFormsAreForms) {
  EXPECT_TRUE(is_form(form("", "Multipart/Form-Data; boundary=\"x y\"")));
  EXPECT_FALSE(is_form(form("", "multipart/mixed; boundary=x")));
  EXPECT_FALSE(is_form(form("", "application/json")));
  EXPECT_EQ(read_form(form("--x y\r\nContent-Disposition: x; name=a\r\n\r\n1\r\n--x y--",
                           "multipart/form-data; boundary=\"x y\""))
                .size(),
            1u);
}

TEST(Multipart, BrokenFormsAreRefused) {
  for (const std::string type : {"multipart/form-data", "multipart/form-data; boundary=",
                                 "multipart/form-data; boundary=\"x"}) {
    EXPECT_NE(refusal(form("--x--", type)), "") << type;
  }
  EXPECT_NE(refusal(form("--x--", "multipart/form-data; boundary=" + std::string(71, 'x'))), "");
  for (const std::string body :
       {"", "no boundary", "--XX", "--XX\r\n", "--XXY\r\n", "--XX\r\n\r\n1\r\n--XX--",
        "--XX\r\nContent-Type: x\r\n\r\n1\r\n--XX--",
        "--XX\r\nContent-Disposition: form-data\r\n\r\n1\r\n--XX--"}) {
    EXPECT_NE(refusal(form(body)), "") << body;
  }
  EXPECT_NE(refusal(form(part("name=a", "1"))), "") << "without its last boundary";
  EXPECT_NE(refusal(form("--XX\r\nX: " + std::string(3000, 'x') + "\r\n\r\n--XX--")), "");
  std::string many;
  for (std::size_t i = 0; i <= kMostFormParts; ++i) many += part("name=a", "1");
  EXPECT_NE(refusal(form(many + "--XX--\r\n")).find("more than 65 parts"), std::string::npos);
}

TEST(Multipart, BytesThatWereChangedAreReadOrRefused) {
  const std::string whole = part("name=\"scene\"", "{}") +
                            part("name=\"mesh\"; filename=\"a.stl\"", "solid") + "--XX--\r\n";
  std::mt19937 dice(1);
  for (int k = 0; k < 5000; ++k) {
    std::string body = whole;
    for (int n = 0; n < 3; ++n) body[dice() % body.size()] = static_cast<char>(dice() % 256);
    if (k % 3 == 0) body.resize(dice() % body.size());
    const Request request = form(body);
    try {
      for (const FormPart& each : read_form(request)) EXPECT_LE(each.bytes.size(), body.size());
    } catch (const ApiError&) {
      continue;
    }
  }
}

}  // namespace
}  // namespace sluice
