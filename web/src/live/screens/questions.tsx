// Questions at the end: scales, choices and free text. What was filled in survives a reload.
import type { JSX } from 'preact';
import { useRef, useState } from 'preact/hooks';
import { Button, Heading } from '../parts/ui';
import type { Question } from '../protocol';
import type { ScreenProps } from '../screen';
import { keep, recall } from '../storage';
import { t } from '../../shared/texts';

type Answers = Record<string, string | number>;
const kLongestText = { one: 2000, all: 4000 }; // characters; a message has at most 16 KiB

export function Questions({ items, connection }: ScreenProps & { items: Question[] }): JSX.Element {
  const [answers, setAnswers] = useState<Answers>(() => recall<Answers>('questions') ?? {});
  const [showsMissing, setShowsMissing] = useState(false);
  const form = useRef<HTMLFormElement>(null);
  const off = connection.isPending('questions');
  const isMissing = ({ id, required }: Question): boolean => required && String(answers[id] ?? '').trim() === '';
  const fillIn = (id: string, value: string | number): void => {
    const filled = { ...answers, [id]: value };
    keep('questions', filled); // at once: a reload may come before the next rendering
    setAnswers(filled);
  };
  const missing = items.filter(isMissing);
  const numTexts = items.filter(({ kind }) => kind === 'text').length;
  const submit = (): void => {
    if (missing.length === 0) {
      const known = new Set(items.map(({ id }) => id));
      const given = Object.entries(answers).filter(([id, value]) => known.has(id) && value !== '');
      connection.send('questions', { answers: Object.fromEntries(given) });
      return;
    }
    setShowsMissing(true);
    const first = items.findIndex(isMissing);
    form.current?.querySelectorAll<HTMLElement>('.question')[first]?.querySelector<HTMLElement>('input, textarea')?.focus();
  };
  return (
    <>
      <Heading>{t('questions.title', { n: items.length })}</Heading>
      <p class="lead">{t('questions.intro')}</p>
      <form
        ref={form}
        noValidate
        onSubmit={(event) => event.preventDefault()}
      >
        {items.map((question, i) => (
          <QuestionView
            question={question}
            name={`question-${i}`}
            value={answers[question.id] ?? ''}
            error={showsMissing && isMissing(question)}
            longest={Math.min(kLongestText.one, Math.floor(kLongestText.all / numTexts))}
            onValue={(value) => fillIn(question.id, value)}
          />
        ))}
        <p role="alert" class="error">
          {showsMissing && missing.length > 0 && t('questions.missing', { n: missing.length })}
        </p>
        <Button primary off={off} onClick={submit}>
          {t(off ? 'questions.submitting' : 'questions.submit')}
        </Button>
      </form>
    </>
  );
}

interface QuestionProps {
  question: Question;
  name: string;
  value: string | number;
  error: boolean;
  longest: number;
  onValue: (value: string | number) => void;
}

function QuestionView({ question, name, value, error, longest, onValue }: QuestionProps): JSX.Element {
  const { kind, text, required } = question;
  const errorId = error ? `${name}-error` : undefined;
  const problem = error && (
    <p class="error" id={errorId}>
      {t('questions.needed')}
    </p>
  );
  const title = (
    <>
      {text}
      {required && <span class="required"> ({t('common.required')})</span>}
    </>
  );
  if (kind === 'text') {
    return (
      <div class="question">
        <label for={name} class="question-text">
          {title}
        </label>
        {problem}
        <textarea
          id={name}
          rows={4}
          maxLength={longest}
          aria-describedby={errorId}
          aria-required={required}
          value={String(value)}
          onInput={(event) => onValue(event.currentTarget.value)}
        />
      </div>
    );
  }
  return (
    <fieldset class={`question ${kind}`} aria-describedby={errorId}>
      <legend class="question-text">{title}</legend>
      {problem}
      <Options {...{ question, name, value, onValue }} />
    </fieldset>
  );
}

function Options({ question, name, value, onValue }: Omit<QuestionProps, 'error' | 'longest'>): JSX.Element {
  const { kind, options, low, high } = question;
  const isScale = kind === 'likert';
  const texts = options && options.length > 0 ? options : Array.from({ length: 7 }, (_, i) => String(i + 1));
  return (
    <div class={isScale ? 'scale' : 'options'}>
      {isScale && low && <span class="end low">{low}</span>}
      <div class="radios">
        {texts.map((text, i) => {
          const own = isScale ? i + 1 : text;
          const end = i === 0 ? low : i === texts.length - 1 ? high : undefined;
          return (
            <label class="tick">
              <input
                type="radio"
                name={name}
                checked={value === own}
                aria-label={isScale && end ? `${text}: ${end}` : undefined}
                onChange={() => onValue(own)}
              />
              <span>{text}</span>
            </label>
          );
        })}
      </div>
      {isScale && high && <span class="end high">{high}</span>}
    </div>
  );
}
