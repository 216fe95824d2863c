"use strict";
// Requests to the session, over HTTP. web/site has another transport, to the session in a worker.
Ahm.transport = { fetch: (name, options) => fetch(name, options) };
