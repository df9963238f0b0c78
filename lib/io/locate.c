// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/locate.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/mem.h"

enum { DEEPEST = 32 };  // lists and groups inside one another

struct vsc_locator {
  yaml_document_t document;
};

static bool indented_by_tab(const char *text, size_t size, size_t line)
{
  const char *end = text + size;
  for (size_t l = 0; l < line; l++) {
    text = memchr(text, '\n', (size_t)(end - text));
    if (text == NULL) return false;
    text++;
  }
  while (text < end && *text == ' ') text++;
  return text < end && *text == '\t';
}

static vsc_status fail_syntax(const yaml_parser_t *parser, const char *file, const char *text,
                              size_t size, vsc_error *error)
{
  size_t line = parser->problem_mark.line;
  if (parser->error == YAML_READER_ERROR) {
    line = 0;
    for (size_t i = 0; i < parser->problem_offset && i < size; i++) line += text[i] == '\n';
    return vsc_fail(error, VSC_INPUT,
                    "%s:%zu: not a text file (%s); expected a YAML scene, see viscera schema", file,
                    line + 1, parser->problem);
  }
  if (indented_by_tab(text, size, line))
    return vsc_fail(error, VSC_INPUT, "%s:%zu: a tab; YAML is indented with spaces only", file,
                    line + 1);
  return vsc_fail(error, VSC_INPUT,
                  "%s:%zu: not valid YAML: %s%s%s; expected key: value lines, see viscera schema",
                  file, line + 1, parser->context != NULL ? parser->context : "",
                  parser->context != NULL ? ", " : "",
                  parser->problem != NULL ? parser->problem : "out of memory");
}

static vsc_status check_nodes(yaml_document_t *document, const char *file, vsc_error *error)
{
  if (yaml_document_get_root_node(document) == NULL)
    return vsc_fail(error, VSC_INPUT, "%s:1: an empty scene; print a template with viscera schema",
                    file);
  for (yaml_node_t *node = document->nodes.start; node < document->nodes.top; node++) {
    if (node->type != YAML_MAPPING_NODE) continue;
    yaml_node_pair_t *const top = node->data.mapping.pairs.top;
    for (yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < top; pair++) {
      const yaml_node_t *key = yaml_document_get_node(document, pair->key);
      if (key->type != YAML_SCALAR_NODE)
        return vsc_fail(error, VSC_INPUT,
                        "%s:%zu: a list or a group stands where a key is expected", file,
                        key->start_mark.line + 1);
    }
  }
  return VSC_OK;
}

static vsc_status check_event(const yaml_event_t *event, const char *file, int *documents,
                              int *depth, vsc_error *error)
{
  const size_t line = event->start_mark.line + 1;
  if (event->type == YAML_DOCUMENT_START_EVENT && ++*documents > 1)
    return vsc_fail(error, VSC_INPUT,
                    "%s:%zu: a second YAML document begins here; a scene is one document", file,
                    line);
  const bool opens =
      event->type == YAML_SEQUENCE_START_EVENT || event->type == YAML_MAPPING_START_EVENT;
  const bool closes =
      event->type == YAML_SEQUENCE_END_EVENT || event->type == YAML_MAPPING_END_EVENT;
  *depth += opens - closes;
  if (event->type == YAML_SCALAR_EVENT && memchr(event->data.scalar.value, '\0', event->data.scalar.length) != NULL)
    return vsc_fail(error, VSC_INPUT, "%s:%zu: a NUL character (\\0) in \"%.60s\"; leave it out", file, line,
                    (const char *)event->data.scalar.value);
  if (*depth <= DEEPEST) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s:%zu: lists and groups inside one another, %d deep; expected a scene, see "
                  "viscera schema",
                  file, line, *depth);
}

// Grammar, number of documents, depth, values that C's strings cannot hold: before the document is loaded, for libyaml takes hours to
// load what is nested a million deep.
static vsc_status check_grammar(const char *file, const char *text, size_t size, vsc_error *error)
{
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return vsc_fail_memory(error, "reading the scene");
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  vsc_status status = VSC_OK;
  int documents = 0, depth = 0;
  for (bool more = true; more && status == VSC_OK;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      status = fail_syntax(&parser, file, text, size, error);
      break;
    }
    more = event.type != YAML_STREAM_END_EVENT;
    status = check_event(&event, file, &documents, &depth, error);
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  return status;
}

vsc_status vsc_locator_open(const char *file, const char *text, size_t size, vsc_locator **locator,
                            vsc_error *error)
{
  yaml_parser_t parser;
  vsc_locator *opened;
  vsc_status status = check_grammar(file, text, size, error);
  if (status != VSC_OK) return status;
  if (!VSC_NEW(opened, 1) || !yaml_parser_initialize(&parser)) {
    vsc_free(opened);
    return vsc_fail_memory(error, "reading the scene");
  }
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  if (!yaml_parser_load(&parser, &opened->document)) {
    status = fail_syntax(&parser, file, text, size, error);
    vsc_free(opened);
  } else {
    status = check_nodes(&opened->document, file, error);
    if (status == VSC_OK)
      *locator = opened;
    else
      vsc_locator_close(opened);
  }
  yaml_parser_delete(&parser);
  return status;
}

// The value of `key` (length bytes) in a mapping, where it stands after `skip` others; NULL if it is not there; *line is
// its key's line.
static yaml_node_t *find_value(yaml_document_t *document, const yaml_node_t *mapping,
                               const char *key, size_t length, int skip, size_t *line)
{
  if (mapping->type != YAML_MAPPING_NODE) return NULL;
  yaml_node_pair_t *const top = mapping->data.mapping.pairs.top;
  for (yaml_node_pair_t *pair = mapping->data.mapping.pairs.start; pair < top; pair++) {
    const yaml_node_t *name = yaml_document_get_node(document, pair->key);
    if (name->data.scalar.length != length) continue;
    if (memcmp(name->data.scalar.value, key, length) != 0 || skip-- > 0) continue;
    *line = name->start_mark.line + 1;
    return yaml_document_get_node(document, pair->value);
  }
  return NULL;
}

static yaml_node_t *find_item(yaml_document_t *document, const yaml_node_t *sequence, size_t item,
                              size_t *line)
{
  if (sequence->type != YAML_SEQUENCE_NODE) return NULL;
  const yaml_node_item_t *start = sequence->data.sequence.items.start;
  if (item >= (size_t)(sequence->data.sequence.items.top - start)) return NULL;
  yaml_node_t *node = yaml_document_get_node(document, start[item]);
  *line = node->start_mark.line + 1;
  return node;
}

// The line of a key, or, of its last part, where that stands after `skip` others.
static size_t find_line(const vsc_locator *locator, const char *key, int skip)
{
  yaml_document_t *document = (yaml_document_t *)&locator->document;
  const yaml_node_t *node = yaml_document_get_root_node(document);
  size_t line = node->start_mark.line + 1;
  while (node != NULL && *key != '\0') {
    if (*key == '[') {
      char *end;
      node = find_item(document, node, strtoul(key + 1, &end, 10), &line);
      key = *end == ']' ? end + 1 : "";
    } else {
      if (*key == '.') key++;
      const size_t length = strcspn(key, ".[");
      node = find_value(document, node, key, length, key[length] == '\0' ? skip : 0, &line);
      key += length;
    }
  }
  return line;
}

size_t vsc_locator_line(const vsc_locator *locator, const char *key)
{
  return find_line(locator, key, 0);
}

size_t vsc_locator_line_again(const vsc_locator *locator, const char *key)
{
  return find_line(locator, key, 1);
}

void vsc_locator_close(vsc_locator *locator)
{
  if (locator == NULL) return;
  yaml_document_delete(&locator->document);
  vsc_free(locator);
}
