"use strict";
// Requests to the session in the worker of index.html, which contains this page.
Ahm.transport = window.parent.ahm;
