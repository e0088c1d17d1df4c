/**
 * The messages between the page and Python, as types.
 *
 * @typedef {{name: string, chosen: boolean}} Offer
 *
 * @typedef {object} ChoiceMessage What can be compared, and what is chosen, as it was typed.
 * @property {"choice"} type
 * @property {Offer[]} rules
 * @property {Offer[]} scenarios
 * @property {string} table Name of the rules in the table.
 * @property {string} arena Name of the scenario of the arena.
 * @property {string} against
 * @property {number | string} runs
 * @property {number | string} seed
 * @property {Object<string, string>} findings What is wrong, by name.
 *
 * @typedef {object} Result A rule set in a scenario.
 * @property {string} rules
 * @property {number[]} collected Of every run.
 * @property {number} mean
 * @property {number} median
 * @property {number} sd
 * @property {?number} p_value
 * @property {?number} p_holm
 * @property {?number} effect
 *
 * @typedef {object} ComparedMessage
 * @property {"compared"} type
 * @property {boolean} busy
 * @property {number} share
 * @property {string} error
 * @property {number} runs
 * @property {number} seed
 * @property {string} against
 * @property {string} explanation
 * @property {{name: string, results: Result[]}[]} scenarios
 *
 * @typedef {object} DraftMessage The next campaign, as it was typed.
 * @property {"draft"} type
 * @property {Object<string, number | string>} values
 * @property {Object<string, string>} findings
 * @property {Offer[]} sizes
 * @property {?number} seconds How long it will take.
 *
 * @typedef {object} StatusMessage The present or last campaign.
 * @property {"status"} type
 * @property {"IDLE" | "RUNNING" | "STOPPED" | "FINISHED" | "FAILED"} phase
 * @property {?string} name
 * @property {number} share
 * @property {string} doing
 * @property {?number} seconds_left
 * @property {string} error
 *
 * @typedef {object} Summary
 * @property {string} name
 * @property {string} problem
 * @property {?{runs: number, generations: number, evaluations: number, seed: number}} plan
 * @property {boolean} reported
 * @property {number} written Seconds since 1970.
 *
 * @typedef {{type: "campaigns", shown: ?string, campaigns: Summary[]}} CampaignsMessage
 *
 * @typedef {object} Claim
 * @property {string} where
 * @property {string} paper
 * @property {string} found
 * @property {"HOLDS" | "FAILS" | "OPEN"} verdict
 * @property {string} words
 *
 * @typedef {object} CampaignMessage The campaign looked at; without a name there is none.
 * @property {"campaign"} type
 * @property {?string} name
 * @property {string} problem
 * @property {number} share
 * @property {boolean} reported
 * @property {{name: string, done: number, total: number}[]} parts
 * @property {{name: string, generation: number[], best_so_far: number[]}[]} curves
 * @property {{name: string, mean: number}[]} levels
 * @property {Claim[]} claims
 *
 * @typedef {{type: "notice", level: "error" | "info", text: string}} NoticeMessage
 */

export {};
