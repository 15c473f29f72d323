/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Furrow's client library: receive wrinkle weights from furrowd, and send it poses.
 *
 *   furrow_connection* connection = NULL;
 *   float weights[256];
 *   furrow_frame frame = {sizeof frame};
 *   if (furrow_open("furrow://127.0.0.1?subject=ada", NULL, &connection) != FURROW_OK) return 1;
 *   while (drawing) {
 *     furrow_poll(connection, 0);
 *     if (furrow_weights(connection, "ada", weights, 256, &frame) == FURROW_OK) draw(weights);
 *   }
 *   furrow_close(connection);
 *
 * Threads   The library starts none. Use a connection on one thread at a time. Different
 *           connections may be used on different threads.
 * Time      No call waits longer than it says, with three exceptions inside furrow_poll(): the
 *           system's resolver for a host that is a name (a numeric address needs none), a message
 *           to a TCP peer that does not read (200 ms), and your own callbacks.
 * Memory    Buffers belong to the caller. The library copies what it keeps, and returns no pointers
 *           that outlive the call, except furrow_status_text() and furrow_version().
 * Text      UTF-8 that ends with a zero byte. Names have at most 255 bytes.
 * Errors    Every function returns a status: 0 and above is normal, below 0 is an error, and then
 *           the connection has not changed; results may have been cleared. Any function may return
 *           FURROW_OUT_OF_MEMORY and FURROW_INTERNAL. furrow_last_error() says what went wrong and
 *           what to do. C++ exceptions never leave the library, and callbacks must not throw.
 * Network   Everything that arrives is checked before use and dropped if it is malformed. A daemon
 *           can neither crash the library nor make it allocate without limit.
 * Losses    A connection opens by itself, and again after every loss, with growing pauses of at
 *           most 0.8 s. Subscriptions and published subjects resume.
 * Versions  Structs begin with `struct_size`: set it to sizeof of the struct, and zero every field
 *           that you do not set. An old program works with a new library: a new library accepts
 *           the old size. A new program works with an old library as long as it leaves the fields
 *           that the library does not know at zero; otherwise it gets FURROW_UNSUPPORTED. A struct
 *           that a callback receives may be shorter: its struct_size says how long it is.
 *           FURROW_ABI_VERSION 0 means that the interface may still change.
 *
 * Needs: a C99 or C++ compiler. The library itself needs the C++ runtime and nothing else.
 */
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define FURROW_API __attribute__((visibility("default")))
#else
#define FURROW_API
#endif

/* The version of this interface. It is 0 until the interface is frozen as 1. */
#define FURROW_ABI_VERSION 0

/* Bytes that hold every name, with its zero byte. */
#define FURROW_NAME_SIZE 256
/* Bytes that hold every timecode, with its zero byte. */
#define FURROW_TIMECODE_SIZE 16
/* Values of one subject, subjects of one connection, and joints and blend shapes of a skeleton. */
#define FURROW_MAX_WEIGHTS 2048
#define FURROW_MAX_SUBJECTS 256
#define FURROW_MAX_JOINTS 1024
#define FURROW_MAX_BLEND_SHAPES 512
/* The longest furrow_poll(), milliseconds. */
#define FURROW_MAX_TIMEOUT_MS 60000

/* --- Status ---------------------------------------------------------------------------------- */

typedef enum furrow_status {
  FURROW_OK = 0,
  FURROW_TIMEOUT = 1, /* nothing happened in time */
  FURROW_NO_DATA = 2, /* nothing has arrived yet, for example because the subject is absent */
  FURROW_CLOSED = 3,  /* a callback closed the connection: do not use it any more */

  FURROW_INVALID_ARGUMENT = -1, /* a null pointer, a wrong size, or a number outside its range */
  FURROW_INVALID_ADDRESS = -2,
  FURROW_UNSUPPORTED = -3, /* a feature that this version does not have */
  FURROW_BUFFER_TOO_SMALL = -4,
  FURROW_NOT_FOUND = -5,     /* no such subscription, value or stream */
  FURROW_LIMIT = -6,         /* too many or too large */
  FURROW_WRONG_CALL = -7,    /* not allowed inside a callback */
  FURROW_NO_CONNECTION = -8, /* not connected at present; the library keeps trying */
  FURROW_REJECTED = -9,      /* the daemon rejected the request */
  FURROW_NO_MATCH = -10,     /* the pattern matches no value of the daemon's wrinkle rig */
  FURROW_OUT_OF_MEMORY = -11,
  FURROW_INTERNAL = -12, /* a bug in the library, or a callback that threw an exception */

  FURROW_UNAUTHENTICATED = -20, /* the daemon asks for a token, or rejects the given one */
  FURROW_FORBIDDEN = -21,       /* the token does not permit this */

  FURROW_TLS_FAILED = -23, /* the daemon's certificate is not trusted, or it does not speak TLS, or
                              it wants a certificate of yours; the library keeps trying. A busy
                              daemon that closes the connection is FURROW_NO_DATA */

  /* Reserved: this version never returns these two, later versions will. Treat them as errors. */
  FURROW_WRONG_SERVER_KEY = -22, /* the daemon does not own the expected key */
  FURROW_REDIRECTED = -24,       /* the subject lives on another daemon, out of reach */

  FURROW_STATUS_IS_32_BITS = 0x7fffffff /* never returned */
} furrow_status;

/* One English sentence for people. Never NULL, also for unknown numbers. Valid forever. */
FURROW_API const char* furrow_status_text(furrow_status status);

/* FURROW_ABI_VERSION of the loaded library, and its release ("0.1.0"). */
FURROW_API uint32_t furrow_abi_version(void);
FURROW_API const char* furrow_version(void);

/* --- Connection ------------------------------------------------------------------------------ */

typedef struct furrow_connection furrow_connection;

typedef enum furrow_state {
  FURROW_CONNECTING = 0, /* the daemon has not answered yet */
  FURROW_CONNECTED = 1,
  FURROW_DISCONNECTED = 2, /* the connection was lost; the library tries again */
  FURROW_STATE_IS_32_BITS = 0x7fffffff
} furrow_state;

/* Flags of furrow_options. */
#define FURROW_OPEN_WITHOUT_SUBSCRIPTION 1u /* do not subscribe: for programs that only publish */

typedef struct furrow_options {
  uint32_t struct_size;   /* sizeof(furrow_options) */
  uint32_t flags;         /* FURROW_OPEN_... */
  const char* program;    /* your program and its version, for the daemon's log; at most 64 bytes */
  char* error;            /* receives the reason if furrow_open() fails; may be NULL */
  uint32_t error_size;    /* bytes of `error` */
  uint32_t tls;           /* 1: TLS over TCP; 0: as the address says */
  const char* token;      /* file with a connect token, or its text; NULL: that of the address */
  const char* server_key; /* reserved for encryption: must be NULL */
  /* File (PEM) with the authorities that the daemon's certificate is checked with, or with that
     certificate itself; implies tls. NULL: that of the address, or those of the system. */
  const char* tls_authority;
} furrow_options;

/*
 * Opens a connection to a daemon. Returns at once: furrow_poll() connects.
 *
 * address     "furrow://host[:port][?key=value&...]" or "host[:port]". Keys:
 *               subject    who to follow; repeat the key for several (default: the oldest subject)
 *               pattern    names of the weights, as comma-separated globs (default: all)
 *               rate       most frames per second, in (0, 1000] (default: every pose)
 *               transport  udp (default, port 7401) or tcp (port 7400)
 *               token      file with a connect token, or its text. Over UDP all is encrypted.
 *                          Over TCP to another computer it needs tls=1 or token-in-clear=1
 *               tls        1: TLS over TCP
 *               tls-authority, tls-certificate, tls-key  files (PEM): what the daemon's certificate
 *                          is checked with, and the client's own certificate and key
 *               token-in-clear  1: permits the token over plain TCP, where everybody on the way
 *                          can read it
 *             Write %26 for '&' and %25 for '%' in values. The key key and transport=shm are
 *             reserved and lead to FURROW_UNSUPPORTED.
 * options     NULL for the defaults.
 * connection  receives the connection; NULL after an error.
 *
 * Errors: FURROW_INVALID_ADDRESS, FURROW_INVALID_ARGUMENT (also a file that cannot be read),
 * FURROW_UNSUPPORTED (a reserved field or key is set), FURROW_OUT_OF_MEMORY. `options->error`
 * receives the reason.
 */
FURROW_API furrow_status furrow_open(const char* address, const furrow_options* options,
                                     furrow_connection** connection);

/*
 * Ends all subscriptions, says goodbye for all published subjects, and frees the connection. NULL
 * is ignored. Inside a callback, the connection ends when the callback has returned.
 */
FURROW_API void furrow_close(furrow_connection* connection);

/*
 * Does all the work of the connection: connects, sends, receives, calls callbacks. Call it once per
 * frame, and at least once per second, because the daemon forgets a silent UDP client after 5 s.
 *
 * Waits for up to `timeout_ms` (0 to FURROW_MAX_TIMEOUT_MS; 0: does not wait) until something
 * happens, and then handles all that has arrived. Returns FURROW_OK if something happened, and
 * FURROW_TIMEOUT otherwise, also while there is no connection.
 *
 * Errors: FURROW_INVALID_ARGUMENT, FURROW_WRONG_CALL (inside a callback), FURROW_INTERNAL.
 */
FURROW_API furrow_status furrow_poll(furrow_connection* connection, int32_t timeout_ms);

typedef struct furrow_connection_info {
  uint32_t struct_size; /* sizeof(furrow_connection_info) */
  furrow_state state;
  uint64_t connects;  /* how often the daemon was reached; above 1: after losses */
  uint64_t malformed; /* messages that were dropped because they were malformed */
  uint32_t subjects;  /* number of subscriptions */
  uint32_t streams;   /* number of published subjects, also withdrawn ones */
} furrow_connection_info;

/* Fills `info`, whose struct_size must be set. Errors: FURROW_INVALID_ARGUMENT. */
FURROW_API furrow_status furrow_get_info(furrow_connection* connection,
                                         furrow_connection_info* info);

/*
 * Copies the message of the last error into `buffer`, cut to `size` - 1 bytes; the text is empty if
 * there was none. It is the reason of the last call that returned an error, or what the daemon or
 * the network reported during furrow_poll().
 */
FURROW_API furrow_status furrow_last_error(furrow_connection* connection, char* buffer,
                                           uint32_t size);

/* --- Weights --------------------------------------------------------------------------------- */

/* Flags of furrow_subscription. */
#define FURROW_SUBSCRIBE_8_BIT 1u   /* a quarter of the bytes; the error is at most 1/510 */
#define FURROW_SUBSCRIBE_DRIVERS 2u /* driver values, before modulation and filter */
#define FURROW_SUBSCRIBE_POSES 4u   /* also the subject's poses; see furrow_latest_pose() */

typedef struct furrow_subscription {
  uint32_t struct_size; /* sizeof(furrow_subscription) */
  uint32_t flags;       /* FURROW_SUBSCRIBE_... */
  const char* subject;  /* NULL or "": the oldest subject that is connected */
  const char* pattern;  /* comma-separated globs, at most 4,096 bytes; NULL or "": all values */
  float max_rate_hz;    /* most frames per second, at most 1000; 0: every pose */
  uint32_t reserved;    /* must be 0 */
} furrow_subscription;

/*
 * Follows one more subject; furrow_open() already does so for the address. The subject need not be
 * connected yet. The functions below find the subscription by `subject`: the name that was asked
 * for, or the name that the daemon chose for "". NULL means the first subscription.
 *
 * A daemon permits 64 subscriptions per connection unless it is configured otherwise; poses count
 * as one more. furrow_weights() returns FURROW_LIMIT for the rest.
 *
 * Errors: FURROW_INVALID_ARGUMENT, also for a subject that is subscribed already; FURROW_LIMIT
 * (more than FURROW_MAX_SUBJECTS); FURROW_UNSUPPORTED (an unknown flag).
 */
FURROW_API furrow_status furrow_subscribe(furrow_connection* connection,
                                          const furrow_subscription* subscription);
/* Ends a subscription. Errors: FURROW_NOT_FOUND. */
FURROW_API furrow_status furrow_unsubscribe(furrow_connection* connection, const char* subject);

/*
 * Copies the name of subscription `index` (0 to furrow_connection_info.subjects - 1, in the order
 * of subscribing). For a subscription to the oldest subject it is the name that the daemon chose,
 * or "" until then. Errors: FURROW_NOT_FOUND, FURROW_BUFFER_TOO_SMALL.
 */
FURROW_API furrow_status furrow_subject_name(furrow_connection* connection, uint32_t index,
                                             char* buffer, uint32_t size);

/* Flags of furrow_frame. */
#define FURROW_FRAME_SUBJECT_GONE 1u /* the subject has left; these are its last weights */
#define FURROW_FRAME_DECAYING 2u     /* no new pose: the daemon holds, then fades to neutral */

/* What belongs to the weights of one moment. */
typedef struct furrow_frame {
  uint32_t struct_size; /* sizeof(furrow_frame) */
  uint32_t flags;       /* FURROW_FRAME_... */
  uint32_t count;       /* number of weights */
  uint32_t sequence;    /* number of the pose, as its publisher counts; it wraps around */
  uint64_t layout;      /* which weights, in which order; see furrow_weights() */
  uint64_t number;      /* frames received so far; differs if this is a new frame */
  uint64_t missed;      /* poses without a frame so far: lost on the way, or skipped by the rate */
  int64_t capture_time_us; /* when the pose was captured, microseconds, on the publisher's clock */
  int64_t age_us;          /* time without a new pose, microseconds: at the daemon and since then */
  /* The SMPTE timecode of the pose, "10:00:00;00" (';': drop-frame); "": its source sends none. */
  char timecode[FURROW_TIMECODE_SIZE];
  uint32_t timecode_rate_numerator; /* its frames per second, as a fraction; 0: none */
  uint32_t timecode_rate_denominator;
} furrow_frame;

/*
 * Copies the newest weights of a subject, each in [0, 1].
 *
 * Weight i always means the same while frame->layout is the same: find your weights by name once,
 * and again when `layout` changes. Equal layouts mean equal names in equal order, also in other
 * programs and after a restart. It changes when the daemon's wrinkle rig changes. It is never 0
 * with weights.
 *
 * values    receives frame->count weights; may be NULL if `capacity` is 0.
 * capacity  number of floats in `values`; FURROW_MAX_WEIGHTS always suffices.
 * frame     filled, also if the buffer is too small; its struct_size must be set. May be NULL.
 *
 * Returns FURROW_NO_DATA before the first frame. Errors: FURROW_BUFFER_TOO_SMALL (nothing was
 * copied), FURROW_NOT_FOUND (no such subscription), FURROW_NO_MATCH and FURROW_REJECTED (the daemon
 * rejected the subscription; the library asks again every 2 s), FURROW_LIMIT (too many
 * subscriptions), FURROW_UNAUTHENTICATED, FURROW_FORBIDDEN and FURROW_TLS_FAILED.
 */
FURROW_API furrow_status furrow_weights(furrow_connection* connection, const char* subject,
                                        float* values, uint32_t capacity, furrow_frame* frame);

/*
 * Number of weights and their layout, known before the first frame. `count` and `layout` may be
 * NULL. Returns FURROW_NO_DATA while they are unknown. Errors: as furrow_weights().
 */
FURROW_API furrow_status furrow_layout(furrow_connection* connection, const char* subject,
                                       uint32_t* count, uint64_t* layout);

/*
 * Copies the name of weight `index`: "<region>.<map>", for example "brow_l.squash".
 * FURROW_NAME_SIZE bytes always suffice. Errors: FURROW_NOT_FOUND, FURROW_BUFFER_TOO_SMALL.
 */
FURROW_API furrow_status furrow_weight_name(furrow_connection* connection, const char* subject,
                                            uint32_t index, char* buffer, uint32_t size);

/* Finds a weight by its name. Errors: FURROW_NOT_FOUND (no such subscription or name). */
FURROW_API furrow_status furrow_find_weight(furrow_connection* connection, const char* subject,
                                            const char* name, uint32_t* index);

/*
 * Functions that furrow_poll() calls. Each may be NULL. All pointers are valid during the call
 * only. Inside a callback you may call every function except furrow_poll(), furrow_subscribe() and
 * furrow_unsubscribe().
 */
typedef struct furrow_callbacks {
  uint32_t struct_size; /* sizeof(furrow_callbacks) */
  uint32_t reserved;    /* must be 0 */
  void* user;           /* passed to every callback */
  /* A new frame. `subject` is the name that the daemon uses; there are frame->count values. */
  void (*on_weights)(void* user, const char* subject, const furrow_frame* frame,
                     const float* values);
  /* The weights of a subject have other names than before, or are known for the first time. */
  void (*on_layout)(void* user, const char* subject, uint64_t layout, const char* const* names,
                    uint32_t count);
  /* The subject has left. Its subscription remains, and resumes when the subject returns. */
  void (*on_subject_gone)(void* user, const char* subject);
  /* The state of the connection has changed. */
  void (*on_state)(void* user, furrow_state state);
} furrow_callbacks;

/* Replaces all callbacks; NULL removes them. The struct is copied. */
FURROW_API furrow_status furrow_set_callbacks(furrow_connection* connection,
                                              const furrow_callbacks* callbacks);

/* --- Poses ----------------------------------------------------------------------------------- */

/*
 * A joint of a skeleton. Right-handed, Y up, a character faces +Z. Everything is local: relative to
 * the parent.
 */
typedef struct furrow_joint {
  const char* name;     /* unique within the skeleton, 1 to 255 bytes */
  int32_t parent;       /* index of an earlier joint; -1 for a root */
  float translation[3]; /* of the rest pose, in the skeleton's unit */
  float rotation[4];    /* of the rest pose: x, y, z, w; any length above 0 */
  float scale[3];       /* of the rest pose; all 0 means 1, 1, 1 */
} furrow_joint;

typedef struct furrow_skeleton {
  uint32_t struct_size; /* sizeof(furrow_skeleton) */
  uint32_t joint_size;  /* sizeof(furrow_joint) */
  const char* subject;  /* the name under which others find this performer, 1 to 255 bytes */
  const furrow_joint* joints;
  uint32_t num_joints;             /* at most FURROW_MAX_JOINTS; 0 if there are blend shapes only */
  uint32_t num_blend_shapes;       /* at most FURROW_MAX_BLEND_SHAPES */
  const char* const* blend_shapes; /* names, unique */
  float metres_per_unit;           /* unit of all lengths; 0 means 1 */
  uint32_t reserved;               /* must be 0 */
} furrow_skeleton;

/*
 * Offers a subject to the daemon. furrow_poll() repeats the offer until the daemon answers, and
 * after every loss. Poses may be sent at once; the daemon drops them until it has the skeleton.
 *
 * stream  receives the number of the subject for the functions below. Numbers are not used again.
 *
 * Errors: FURROW_INVALID_ARGUMENT (furrow_last_error() names the joint or blend shape);
 * FURROW_LIMIT (too many or too large; over UDP an offer has at most 131,072 bytes).
 */
FURROW_API furrow_status furrow_offer(furrow_connection* connection,
                                      const furrow_skeleton* skeleton, uint32_t* stream);

/* Flags of furrow_pose. */
#define FURROW_POSE_PACKED 1u /* 6 bytes per rotation and translation; error below 0.01 degrees */
/* Over UDP, also repeats the stream's pose before in the same datagram, if both fit; packs both. */
#define FURROW_POSE_REDUNDANT 2u

/* One pose. An array that is NULL leaves its part at rest, and blend shapes at 0. */
typedef struct furrow_pose {
  uint32_t struct_size;      /* sizeof(furrow_pose) */
  uint32_t flags;            /* FURROW_POSE_... */
  int64_t capture_time_us;   /* microseconds of any clock that never runs backwards; below 2^62 */
  const float* rotations;    /* 4 per joint, local: x, y, z, w; any length above 0 */
  const float* translations; /* 3 per joint: the whole local translation, not an offset from rest */
  const float* scales;       /* 3 per joint */
  const float* blend_shapes; /* 1 per blend shape */
} furrow_pose;

/*
 * Sends one pose of a stream. All numbers must be finite, and at most 1e6 in magnitude.
 *
 * Errors: FURROW_INVALID_ARGUMENT, FURROW_NOT_FOUND (no such stream), FURROW_NO_CONNECTION (the
 * pose was dropped; go on sending), FURROW_REJECTED (see furrow_stream_status()),
 * FURROW_UNAUTHENTICATED and FURROW_TLS_FAILED (no connection, because of that).
 */
FURROW_API furrow_status furrow_send_pose(furrow_connection* connection, uint32_t stream,
                                          const furrow_pose* pose);

/*
 * What became of an offer: FURROW_OK (accepted), FURROW_NO_DATA (no answer yet), FURROW_REJECTED
 * (furrow_last_error() states the reason; another publisher may have taken the subject over) or
 * FURROW_NOT_FOUND.
 */
FURROW_API furrow_status furrow_stream_status(furrow_connection* connection, uint32_t stream);

/* Ends a stream, so that subscribers learn at once that the subject has left. */
FURROW_API furrow_status furrow_withdraw(furrow_connection* connection, uint32_t stream);

/* --- Poses of others ------------------------------------------------------------------------- */

/* Below, `subject` names a subscription with FURROW_SUBSCRIBE_POSES, as for furrow_weights(). */

typedef struct furrow_skeleton_info {
  uint32_t struct_size; /* sizeof(furrow_skeleton_info) */
  uint32_t num_joints;
  uint32_t num_blend_shapes;
  float metres_per_unit; /* unit of all lengths */
  uint64_t layout;       /* changes with the joints, their rest pose, and the blend shapes */
} furrow_skeleton_info;

/*
 * Describes the skeleton of a subject; info->struct_size must be set. Returns FURROW_NO_DATA before
 * it has arrived. Errors: FURROW_NOT_FOUND (no such subscription, or one without poses),
 * FURROW_LIMIT (the skeleton is too large for UDP), FURROW_REJECTED. After a rejection the library
 * asks again every 2 s.
 */
FURROW_API furrow_status furrow_get_skeleton(furrow_connection* connection, const char* subject,
                                             furrow_skeleton_info* info);
/*
 * Copies joint `index`: its name into `name`, which has `size` bytes, and the rest into `joint`,
 * which may be NULL; joint->name then points to `name`. Errors: as furrow_get_skeleton(), and
 * FURROW_BUFFER_TOO_SMALL.
 */
FURROW_API furrow_status furrow_get_joint(furrow_connection* connection, const char* subject,
                                          uint32_t index, char* name, uint32_t size,
                                          furrow_joint* joint);
/* Copies the name of blend shape `index`. Errors: as furrow_get_joint(). */
FURROW_API furrow_status furrow_blend_shape_name(furrow_connection* connection, const char* subject,
                                                 uint32_t index, char* buffer, uint32_t size);

/* Buffers for a pose, and what belongs to it. Arrays that are NULL are left out. */
typedef struct furrow_pose_buffer {
  uint32_t struct_size;      /* sizeof(furrow_pose_buffer) */
  uint32_t sequence;         /* out: as furrow_frame, like `number`, `capture_time_us`, `age_us` */
  uint32_t num_joints;       /* in: joints that the arrays hold; out: joints of the skeleton */
  uint32_t num_blend_shapes; /* in and out, as num_joints */
  float* rotations;          /* 4 per joint, local: x, y, z, w, of length 1 */
  float* translations;       /* 3 per joint: the whole local translation */
  float* scales;             /* 3 per joint */
  float* blend_shapes;       /* 1 per blend shape */
  uint64_t layout;           /* out: that of the skeleton */
  uint64_t number;           /* out: poses received so far */
  int64_t capture_time_us;   /* out */
  int64_t age_us;            /* out: time since the pose arrived, microseconds */
} furrow_pose_buffer;

/*
 * Copies the newest pose of a subject. Set struct_size, the arrays, and their sizes; the sizes are
 * replaced, so set them before each call. Returns FURROW_NO_DATA before the first pose. Errors: as
 * furrow_get_skeleton(), and FURROW_BUFFER_TOO_SMALL (no array was changed).
 */
FURROW_API furrow_status furrow_latest_pose(furrow_connection* connection, const char* subject,
                                            furrow_pose_buffer* pose);

#ifdef __cplusplus
} /* extern "C" */
#endif
