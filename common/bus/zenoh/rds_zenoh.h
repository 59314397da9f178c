/* SPDX-License-Identifier: Apache-2.0 */
/* Zenoh, as far as the back end of the bus needs it: what crate/ exports as one table of functions. Every object is the
 * caller's until he gives it back. NULL or 0 means failure, with its text in `error` (of `capacity` bytes, with a 0 at
 * the end). All functions may be called from any thread; none unwinds. Callbacks run on threads of Zenoh: they take
 * what they are given and do not wait; `release` is called when none can come any more, and always. */
#ifndef RDS_ZENOH_H
#define RDS_ZENOH_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

#define RDS_ZENOH_VERSION 5 /* of this file; the crate has the same number */

typedef struct RdsZenohSession RdsZenohSession;
typedef struct RdsZenohPublisher RdsZenohPublisher;
typedef struct RdsZenohSubscriber RdsZenohSubscriber;
typedef struct RdsZenohBuffer RdsZenohBuffer;
typedef struct RdsZenohSample RdsZenohSample;
typedef struct RdsZenohQueryable RdsZenohQueryable;
typedef struct RdsZenohQuery RdsZenohQuery;
typedef struct RdsZenohToken RdsZenohToken;
typedef struct RdsZenohWatch RdsZenohWatch;

typedef struct {
  uint8_t priority; /* 1 (real time) ... 7 (background) */
  uint8_t express;  /* not held back to be sent with others */
  uint8_t reliable;
  uint8_t droppable;     /* messages are small, and each may be lost on a link that is full */
  uint8_t latched;       /* found by subscribers that ask for history */
  size_t cache;          /* messages kept, for those who join late or have lost some; 0: none */
  uint64_t heartbeat_ms; /* says so often how far it is, if that has changed; 0: never */
} RdsZenohPublisherOptions;

typedef struct {
  size_t history;  /* asks each publisher for so many messages of before; 0: none */
  uint8_t recover; /* asks again for what was lost, of publishers with cache and heartbeat */
} RdsZenohSubscriberOptions;

#define RDS_ZENOH_ATTACHMENT 64 /* bytes that a view shows */

typedef struct {
  const char* key; /* not terminated */
  size_t key_size;
  const uint8_t* data; /* NULL if the payload lies in pieces: gather() then */
  size_t size;
  size_t attachment_size;
  uint8_t attachment[RDS_ZENOH_ATTACHMENT];
  char source[33]; /* the writing session's identifier, as id() writes it; "" if the message does not say */
} RdsZenohView;

typedef void (*RdsZenohOnSample)(void* object, RdsZenohSample* sample); /* the callback owns the sample */
typedef void (*RdsZenohOnQuery)(void* object, RdsZenohQuery* query);    /* the callback owns the query */
typedef void (*RdsZenohOnToken)(void* object, const char* key, size_t key_size, int alive);
typedef void (*RdsZenohOnLog)(const char* text, size_t size);
typedef void (*RdsZenohRelease)(void* object);

typedef struct {
  uint32_t version;
  /* From now on the callback gets what Zenoh logs of links that do not come about or break, of all sessions. Once. Who
   * sets RUST_LOG has Zenoh's own log on the standard output in place of it. */
  void (*listen_to_log)(RdsZenohOnLog callback);
  /* settings: a Zenoh configuration in JSON5. over: a file of the same form that wins over it, element by element;
   * NULL: none. */
  RdsZenohSession* (*open)(const char* settings, const char* over, char* error, size_t capacity);
  /* All that was made from the session has gone before. */
  void (*close)(RdsZenohSession* session);
  /* At most 32 hexadecimal digits and a 0. */
  void (*id)(const RdsZenohSession* session, char* text);

  RdsZenohPublisher* (*declare_publisher)(const RdsZenohSession* session, const char* key,
                                          const RdsZenohPublisherOptions* options, char* error, size_t capacity);
  void (*undeclare_publisher)(RdsZenohPublisher* publisher);
  /* Memory to write a message into; to `share` with the other processes of the machine, if the session's settings
   * allow it. */
  RdsZenohBuffer* (*make_buffer)(const RdsZenohSession* session, size_t size, uint8_t share, uint8_t** data);
  void (*free_buffer)(RdsZenohBuffer* buffer);
  /* Takes the buffer, whatever comes of it. May wait for a link that is full, as long as its settings say. */
  int (*put)(const RdsZenohPublisher* publisher, RdsZenohBuffer* buffer, const uint8_t* attachment,
             size_t attachment_size);

  RdsZenohSubscriber* (*declare_subscriber)(const RdsZenohSession* session, const char* key,
                                            const RdsZenohSubscriberOptions* options, RdsZenohOnSample callback,
                                            void* object, RdsZenohRelease release, char* error, size_t capacity);
  void (*undeclare_subscriber)(RdsZenohSubscriber* subscriber);
  void (*view)(const RdsZenohSample* sample, RdsZenohView* view);
  /* 0: what view() has shown may have been another message already (shared memory of which a reader that was frozen
   * has lost its hold). Asked for after it was read. */
  int (*intact)(const RdsZenohSample* sample);
  void (*gather)(const RdsZenohSample* sample, uint8_t* data); /* room for the whole payload */
  void (*free_sample)(RdsZenohSample* sample);

  /* Answers whoever asks by get(). A query that is given back is over for who has asked. */
  RdsZenohQueryable* (*declare_queryable)(const RdsZenohSession* session, const char* key, RdsZenohOnQuery callback,
                                          void* object, RdsZenohRelease release, char* error, size_t capacity);
  void (*undeclare_queryable)(RdsZenohQueryable* queryable);
  void (*view_query)(const RdsZenohQuery* query, RdsZenohView* view);
  void (*gather_query)(const RdsZenohQuery* query, uint8_t* data); /* room for the whole payload */
  /* Takes the buffer, whatever comes of it. May wait as put(), longer where who asks wants it so. */
  int (*reply)(const RdsZenohQuery* query, RdsZenohBuffer* buffer, const uint8_t* attachment, size_t attachment_size);
  void (*free_query)(RdsZenohQuery* query);
  /* Asks all complete queryables at a key; takes the buffer. The callback gets each answer. */
  int (*get)(const RdsZenohSession* session, const char* key, RdsZenohBuffer* buffer, const uint8_t* attachment,
             size_t attachment_size, uint64_t timeout_ms, RdsZenohOnSample callback, void* object,
             RdsZenohRelease release);

  RdsZenohToken* (*declare_token)(const RdsZenohSession* session, const char* key, char* error, size_t capacity);
  void (*undeclare_token)(RdsZenohToken* token);
  /* Tells of every token that there is, then of each that comes or goes. */
  RdsZenohWatch* (*declare_watch)(const RdsZenohSession* session, const char* key, RdsZenohOnToken callback,
                                  void* object, RdsZenohRelease release, char* error, size_t capacity);
  void (*undeclare_watch)(RdsZenohWatch* watch);
} RdsZenohApi;

const RdsZenohApi* rds_zenoh_api(void);

#ifdef __cplusplus
}
#endif
#endif
