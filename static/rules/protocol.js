// What Python and the rule table page say to one another: written by `python -m app.protocol`.

/** @typedef {ReturnType<typeof edits[keyof typeof edits]>} AnyEdit */
/** @typedef {"preconditions" | "behaviours" | "actions"} RulePart */
/** @typedef {Precondition | Term | Action} RuleElement */
/** @typedef {BehaviourChange | StateChange} Action */
/** @typedef {boolean | number | string} Value */
/** @typedef {"error" | "warning" | "hint"} Severity */
/** @typedef {{name: string, title: string}} PresetOffer A rule set that can be loaded by its name. */
/** @typedef {{role: string, name: string, fitness: number[]}} RoleSample The objective in each run. */
/** @typedef {{name: string, you: boolean}} Person Somebody who looks at the rules. */

/**
 * The names that rules are made of, with their colours, the presets, and the objective.
 * @typedef {object} VocabularyMessage
 * @property {"vocabulary"} type
 * @property {PerceptOffer[]} preconditions
 * @property {BehaviourOffer[]} behaviours
 * @property {StateOffer[]} internal_states
 * @property {number[]} probabilities
 * @property {PresetOffer[]} presets
 * @property {ObjectiveOffer} objective
 */

/**
 * The rules as they stand, in all their forms, with what is known of them so far.
 * @typedef {object} RulesMessage
 * @property {"rules"} type
 * @property {number} version
 * @property {boolean} can_undo
 * @property {boolean} can_redo
 * @property {RuleSet} rule_set
 * @property {string[]} english Each rule as a sentence.
 * @property {string} text The rule set in the rule language.
 * @property {string[]} rule_texts Each rule in the rule language.
 * @property {RuleSet} loaded The version loaded last.
 * @property {string} loaded_text The same in the rule language.
 * @property {RuleFinding[]} findings
 * @property {number} [simpler] Elements that can go without changing the behaviour; absent while unknown.
 */

/**
 * The shortest rules that behave as those of a version, and what they leave out.
 * @typedef {object} SimplifiedMessage
 * @property {"simplified"} type
 * @property {number} version
 * @property {RuleSet} rule_set
 * @property {string} text
 * @property {string[]} removed
 */

/**
 * What there is to know about a text that was typed.
 * @typedef {object} TextFindingsMessage
 * @property {"text_findings"} type
 * @property {RuleFinding[]} findings
 */

/**
 * What the swarm does now.
 * @typedef {object} LiveMessage
 * @property {"live"} type
 * @property {number} time Simulated time, s.
 * @property {number[]} fired How often each rule has fired since the start, all robots together.
 * @property {number[]} behaviours Robots in each behaviour, in the order of the vocabulary.
 * @property {number} robots
 */

/**
 * The state machine of the rules and its picture.
 * @typedef {object} StatesMessage
 * @property {"states"} type
 * @property {string} svg Drawn by geswarm.exports.brief_svg.
 * @property {DrawnState[]} states
 * @property {DrawnTransition[]} transitions
 */

/**
 * What the swarm does in the state machine that was sent last.
 * @typedef {object} ActivityMessage
 * @property {"activity"} type
 * @property {number} time Simulated time, s.
 * @property {number[]} robots In each state.
 * @property {number[]} taken How often each transition was taken since the rules were set.
 * @property {number} swarm Robots in all.
 */

/**
 * What is known of the verdict.
 * @typedef {object} VerdictMessage
 * @property {"verdict"} type
 * @property {number} version
 * @property {boolean} busy
 * @property {string} scenario
 * @property {number} runs How many there will be in each sample.
 * @property {RoleSample[]} samples
 * @property {RoleComparison[]} comparisons
 */

/**
 * What is known of the worth of each piece.
 * @typedef {object} WorthMessage
 * @property {"worth"} type
 * @property {number} version
 * @property {boolean} busy
 * @property {number} done
 * @property {number} total
 * @property {WeighedPiece[]} pieces
 */

/**
 * A file to download.
 * @typedef {object} FileMessage
 * @property {"file"} type
 * @property {string} name
 * @property {string} text
 */

/**
 * Who is there.
 * @typedef {object} PeopleMessage
 * @property {"people"} type
 * @property {Person[]} people
 */

/**
 * Somebody else did that.
 * @typedef {object} ChangedMessage
 * @property {"changed"} type
 * @property {string} who
 * @property {string} what
 */

/**
 * A change was not made: it was meant for a version that is no longer there.
 * @typedef {object} StaleMessage
 * @property {"stale"} type
 * @property {number} version The one that it was meant for.
 * @property {string} text
 */

/**
 * What killed dashboards left.
 * @typedef {object} UnsavedMessage
 * @property {"unsaved"} type
 * @property {UnsavedRules[]} left
 */

/**
 * One rule: active if all preconditions hold and the behaviour is among `behaviours`.
 * @typedef {object} Rule
 * @property {Precondition[]} preconditions All must hold; none means always.
 * @property {Term[]} behaviours The current behaviour must be among them; none means any.
 * @property {Action[]} actions Each drawn on its own, in order.
 * @property {string} comment What the rule is for, in the author's words.
 * @property {boolean} enabled False switches the rule off without deleting it.
 */

/**
 * A percept compared with a value: `ON_NEST == true`, `NEIGHBOURS >= 3` (production 7).
 * @typedef {object} Precondition
 * @property {Term} percept What is compared: a precondition of the vocabulary, or an internal state.
 * @property {Value} value What with.
 * @property {string} comparison One of COMPARISONS.
 */

/**
 * What rules are made of, as a rule mentions it: `ON_NEST`, `IS_CLOSE_TO(3)`.
 * @typedef {object} Term
 * @property {string} name Of a precondition or a behaviour of the vocabulary.
 * @property {Value[]} arguments In the order of its declaration.
 */

/**
 * With probability p per control step, change to `behaviour` (production 10).
 * @typedef {object} BehaviourChange
 * @property {number} p
 * @property {Term} behaviour
 */

/**
 * With probability p per control step, change the internal state `state` (production 11).
 * @typedef {object} StateChange
 * @property {number} p The probability.
 * @property {string} state Its name.
 * @property {Value} value What it becomes, or by how much a counter changes.
 * @property {string} operation One of OPERATIONS.
 */

/**
 * What can be compared in a precondition.
 * @typedef {object} PerceptOffer
 * @property {string} name
 * @property {string} holds Words, which may hold arguments in braces.
 * @property {string} fails The same for its contrary.
 * @property {ArgumentOffer[]} arguments
 * @property {Value[]} values
 * @property {string[]} comparisons
 */

/**
 * A behaviour of the vocabulary.
 * @typedef {object} BehaviourOffer
 * @property {string} name
 * @property {string} doing Words, which may hold arguments in braces.
 * @property {string} colour Of the LEDs.
 * @property {ArgumentOffer[]} arguments
 */

/**
 * An internal state of the vocabulary.
 * @typedef {object} StateOffer
 * @property {string} name
 * @property {string} on
 * @property {string} off
 * @property {Value[]} values
 * @property {boolean} counts
 */

/**
 * What rules are for.
 * @typedef {object} ObjectiveOffer
 * @property {string} expression Over measures.
 * @property {string} unit Of its values.
 * @property {string} label Both.
 * @property {boolean} maximise More is better.
 */

/**
 * The controller that every robot of the swarm runs.
 * @typedef {object} RuleSet
 * @property {Rule[]} rules In order, R1 first.
 * @property {string} name What it is called.
 * @property {string} comment What it is for, in the author's words.
 * @property {Origin} origin Where it came from.
 * @property {string} scenario Name of the scenario in whose words it was written; empty for foraging's.
 */

/**
 * Something to know about the rules.
 * @typedef {object} RuleFinding
 * @property {?number} line Of the text, if it was typed.
 * @property {?number} rule Number of the rule, from 1; null if it is about all of them.
 * @property {string} element
 * @property {string} message
 * @property {Severity} severity A hint is true but harmless.
 */

/**
 * A state of the state machine.
 * @typedef {object} DrawnState
 * @property {string} label
 * @property {Term} behaviour
 * @property {string} means What robots in it do, in words.
 * @property {boolean} initial
 */

/**
 * A transition of the state machine.
 * @typedef {object} DrawnTransition
 * @property {number} source Index of a state.
 * @property {number} target Index of a state.
 * @property {string} when Its condition.
 * @property {string} rate Probability per control step and mean waiting time, in words.
 * @property {string[]} effects What it does besides, in words.
 * @property {number[]} rules Numbers of the rules behind it, from 1.
 * @property {string} words All of this in a line.
 */

/**
 * Mean of the current rules minus mean of the other's, same seeds.
 * @typedef {object} RoleComparison
 * @property {string} role The other rules.
 * @property {number} difference
 * @property {number} low Lower end of the 95 % interval.
 * @property {number} high Upper end.
 * @property {?number} p_value
 */

/**
 * Mean without the piece minus mean with it, and its 95 % interval.
 * @typedef {object} WeighedPiece
 * @property {number} rule
 * @property {"rule" | RulePart} part
 * @property {?number} at
 * @property {number} difference
 * @property {number} low
 * @property {number} high
 * @property {?number} p_value
 */

/**
 * Rules of a dashboard that was killed.
 * @typedef {object} UnsavedRules
 * @property {string} file
 * @property {string} name
 * @property {number} rules How many.
 * @property {number} edited Seconds since 1970.
 */

/**
 * What may stand in the parentheses of a term.
 * @typedef {object} ArgumentOffer
 * @property {string} name
 * @property {string} unit
 * @property {Value[]} offered
 */

/**
 * Where a rule set came from; fields that do not apply are None.
 * @typedef {object} Origin
 * @property {?string} preset
 * @property {?string} run
 * @property {?number} generation
 * @property {?number} fitness
 */

/** Messages to Python. */
export const request = {
  /** Make one edit. @param {AnyEdit} edit @param {number} [version] */
  edit: (edit, version) => ({ type: "edit", edit, version }),
  /** Take the last change back. @param {number} [version] */
  undo: (version) => ({ type: "undo", version }),
  /** Make the change again that was taken back last. @param {number} [version] */
  redo: (version) => ({ type: "redo", version }),
  /** Change the rules to what was typed. @param {string} text @param {number} [version] */
  setText: (text, version) => ({ type: "set_text", text, version }),
  /** Put the shortest rules in place that were shown for a version. @param {number} [version] */
  takeSimplified: (version) => ({ type: "take_simplified", version }),
  /** Load a preset. @param {string} name */
  loadPreset: (name) => ({ type: "load_preset", name }),
  /** Load the text of a file. @param {string} text @param {string} name Of the file. */
  loadText: (text, name) => ({ type: "load_text", text, name }),
  /** Answer with a file. @param {"yaml" | "text" | "json"} format */
  save: (format) => ({ type: "save", format }),
  /** Answer with what is wrong with a text. @param {string} text */
  checkText: (text) => ({ type: "check_text", text }),
  /** Answer with the shortest rules. */
  simplify: () => ({ type: "simplify" }),
  /** A key of the arena was pressed over the table. @param {"P" | "O" | "X" | "F" | "R"} key */
  key: (key) => ({ type: "key", key }),
  /** Find out what each piece is worth. */
  worthStart: () => ({ type: "worth_start" }),
  /** Do not go on with that. */
  worthCancel: () => ({ type: "worth_cancel" }),
  /** This is who looks at the page. @param {string} name */
  name: (name) => ({ type: "name", name }),
  /** Put these rules in place. @param {string} file */
  bringBack: (file) => ({ type: "bring_back", file }),
  /** Forget these rules. @param {string} file */
  discard: (file) => ({ type: "discard", file }),
};

/** Edits, for `request.edit`. */
export const edits = {
  /** The rules are called something else. @param {string} name */
  setName: (name) => ({ do: "set_name", name }),
  /** A rule is put in. @param {number} at @param {Rule} rule */
  addRule: (at, rule) => ({ do: "add_rule", at, rule }),
  /** Rules in the rule language are put in. @param {number} at @param {string} text */
  pasteRules: (at, text) => ({ do: "paste_rules", at, text }),
  /** A rule is taken out. @param {number} rule */
  removeRule: (rule) => ({ do: "remove_rule", rule }),
  /** The same rule once more, behind it. @param {number} rule */
  duplicateRule: (rule) => ({ do: "duplicate_rule", rule }),
  /** A rule goes to another place. @param {number} rule @param {number} to Where it is then. */
  moveRule: (rule, to) => ({ do: "move_rule", rule, to }),
  /** A rule is switched on or off. @param {number} rule @param {boolean} enabled */
  setEnabled: (rule, enabled) => ({ do: "set_enabled", rule, enabled }),
  /** A rule is explained. @param {number} rule @param {string} comment */
  setComment: (rule, comment) => ({ do: "set_comment", rule, comment }),
  /**
   * Another element is put in.
   *
   * @param {number} rule
   * @param {RulePart} part
   * @param {number} at
   * @param {RuleElement} element
   */
  add: (rule, part, at, element) => ({ do: "add", rule, part, at, element }),
  /**
   * An element becomes another one.
   *
   * @param {number} rule
   * @param {RulePart} part
   * @param {number} at
   * @param {RuleElement} element
   */
  set: (rule, part, at, element) => ({ do: "set", rule, part, at, element }),
  /** An element is taken out. @param {number} rule @param {RulePart} part @param {number} at */
  remove: (rule, part, at) => ({ do: "remove", rule, part, at }),
};
